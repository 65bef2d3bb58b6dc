"""Figures of a study, drawn in several processes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Callable, Dict, Mapping, Optional, Union

from .._core import QuadcoreError
from ..report.drawing import Drawing
from .executor import count_cores, run_cases

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Figures = Dict[str, Callable[[], "Figure"]]
"""Functions that make figures, by name."""


def draw_figures(
    figures: Mapping[str, Callable[[], Figure]],
    processes: Optional[int] = None,
    is_on_page: bool = True,
) -> Dict[str, Drawing]:
    """Make figures and draw them.

    Parameters
    ----------
    figures
        Functions that make the figures, by name.
    processes
        Number of processes; None: one per usable core. A single one is this process.
    is_on_page
        Whether a page will show the drawings.

    Returns
    -------
    dict
        `Drawing` by name, in the same order. They do not depend on the number of processes.

    Raises
    ------
    QuadcoreError
        If a process cannot be started, or dies.
    """
    if not figures:
        return {}
    from ..report import plots  # matplotlib is slow to import, and forks share it

    def draw(name: str) -> Drawing:
        return plots.finish(figures[name](), is_on_page)

    def take(index: int, drawing: Union[Drawing, QuadcoreError]) -> None:
        if isinstance(drawing, QuadcoreError):
            raise QuadcoreError(f"figure '{names[index]}': {drawing}") from drawing
        drawn[index] = drawing

    names = list(figures)
    processes = min(len(names), processes or count_cores())
    if processes < 2:
        return {name: draw(name) for name in names}
    drawn: Dict[int, Drawing] = {}
    run_cases(draw, names, take, processes)
    return {name: drawn[index] for index, name in enumerate(names)}
