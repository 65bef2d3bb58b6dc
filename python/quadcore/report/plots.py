"""Parts that all plots share: figures, panels, axes, and their style."""

from __future__ import annotations

import io
import os
import sys
from typing import Any, Dict, Optional, Sequence, Tuple

import numpy as np

from .._core import InputError
from ..support.output_files import encode_text
from .drawing import Drawing, get_formats, make_element


def _describe_mix() -> str:
    """Name both installations of matplotlib that meet here, and the command that repairs it."""
    import matplotlib

    folder = os.path.dirname(matplotlib.__path__[0])
    others = ", ".join(sys.modules["mpl_toolkits"].__path__)
    return (
        f"matplotlib {matplotlib.__version__} in {folder} finds the mpl_toolkits of another "
        f"matplotlib in {others}. Run '{sys.executable} -m pip uninstall matplotlib' to use the "
        "other, or install quadcore in a virtual environment without system packages."
    )


# Files need no window, and a wrong name of a toolkit for windows must not end a flight.
_toolkit = os.environ.pop("MPLBACKEND", None)
try:
    from matplotlib import rc_params_from_file
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import ScalarFormatter
    from mpl_toolkits.mplot3d import Axes3D  # noqa: F401  (matplotlib < 3.2 needs it for "3d")
except ImportError as error:
    if "mpl_toolkits" not in sys.modules:
        raise
    raise InputError(_describe_mix()) from error
finally:
    if _toolkit is not None:
        os.environ["MPLBACKEND"] = _toolkit

# Read, not used: matplotlib's settings are global, and would affect other threads.
_STYLE: Dict[str, Any] = rc_params_from_file(  # type: ignore[assignment]
    os.path.join(os.path.dirname(__file__), "quadcore.mplstyle"), use_default_template=False
)
AXES = ("#d55e00", "#009e73", "#0072b2")  # colours of x, y, z in all plots
REFERENCE = {"color": "0.25", "linestyle": (0, (4, 3)), "linewidth": 1, "label": "reference"}
WHOLE = (0.0, 0.02, 0.94, 0.94)  # part of a figure that 3D axes fill
_METADATA: Dict[str, Dict[str, Optional[str]]] = {  # without versions and dates
    "png": {"Software": "quadcore"},
    "svg": {"Date": None, "Creator": "quadcore"},
    "pdf": {"CreationDate": None, "Creator": "quadcore", "Producer": "quadcore"},
}
NOTHING = 1e-6  # m, m/s, rad/s, deg: a smaller range is rounding noise


def png(figure: Figure) -> bytes:
    """Return a figure as PNG. Identical flights give identical bytes."""
    return _write(figure, "png")


def finish(figure: Figure, is_on_page: bool = True) -> Drawing:
    """Draw a figure as files in the formats of `get_formats`, and as an SVG element for a page."""
    formats = get_formats()
    element = ""
    if is_on_page or "svg" in formats:
        element = make_element(_write(figure, "svg").decode())
    document = encode_text(f'<?xml version="1.0" encoding="utf-8"?>\n{element}\n')
    files = {kind: document if kind == "svg" else _write(figure, kind) for kind in formats}
    return Drawing(str(figure.get_label()), element, files)


def _write(figure: Figure, kind: str) -> bytes:
    FigureCanvasAgg(figure)
    stream = io.BytesIO()
    figure.savefig(stream, format=kind, metadata=_METADATA[kind])
    return stream.getvalue()


def add_unslowed_axis(axes: Any, per_command: float) -> None:
    """Add an axis on the right that shows the joint speed times the slowdown."""
    conversions = (lambda rate: rate / per_command, lambda speed: speed * per_command)
    axes.secondary_yaxis("right", functions=conversions).set_ylabel(
        r"$\times$ slowdown (rad/s)", fontsize="small"
    )


def space(figure: Figure, place: Any, paths: Sequence[np.ndarray]) -> Tuple[Any, np.ndarray]:
    """Add 3D axes to a figure, with room for paths, each (rows, 3).

    Returns
    -------
    tuple
        The axes and their low corner.
    """
    axes = figure.add_axes(place, projection="3d")
    # The same scale along all three axes, with room for flights that hardly move.
    low = np.min([path.min(axis=0) for path in paths], axis=0)
    high = np.max([path.max(axis=0) for path in paths], axis=0)
    reach = max((high - low).max() / 2, 0.1)
    corner = (low + high) / 2 - reach
    for name, start in zip("xyz", corner):
        getattr(axes, f"set_{name}lim")(start, start + 2 * reach)
        getattr(axes, f"set_{name}label")(f"{name} (m)")
    axes.locator_params(nbins=5, prune="both")  # neighbours do not touch
    return axes, corner


def panels(
    title: str,
    rows: int,
    columns: int = 1,
    height: float = 1.6,
    above: float = 0.5,
    right: float = 0.1,
) -> tuple[Figure, Any]:
    """Make a figure of panels over time, `height` inches each, with room for title and legend."""
    width, below = (8.0 if columns > 1 else 7.0), 0.5  # inch
    total = above + height * rows + below
    figure = make_figure(title, width, total)
    # Fixed margins: matplotlib's automatic layouts differ from version to version.
    margins = {
        "left": 1.1 / width,
        "right": 1 - right / width,
        "top": 1 - above / total,
        "bottom": below / total,
        "wspace": 0.38,
        "hspace": 0.18,
    }
    grid = subplots(figure, rows, columns, margins, sharex=True)
    for axes in grid[-1]:
        axes.set_xlabel("time (s)")
    return figure, grid


def subplots(figure: Figure, rows: int, columns: int, margins: Any, **shared: Any) -> Any:
    """Add styled panels to a figure; tick labels have at most nine characters."""
    grid = figure.subplots(rows, columns, squeeze=False, gridspec_kw=margins, **shared)
    for axes in grid.flat:
        dress(axes)
        axes.yaxis.set_major_formatter(_Numbers())
        axes.ticklabel_format(axis="y", scilimits=_STYLE["axes.formatter.limits"])
    figure.align_ylabels(grid)
    return grid


class _Numbers(ScalarFormatter):
    """Use an axis offset only if it shortens the tick labels by seven digits.

    Matplotlib's own setting for this is global and would affect other threads.
    """

    def __init__(self) -> None:
        super().__init__()
        self._offset_threshold = 7


def dress(axes: Any) -> None:
    """Style a panel."""
    axes.grid(color=_STYLE["grid.color"], linewidth=_STYLE["grid.linewidth"])
    axes.set_axisbelow(_STYLE["axes.axisbelow"])
    axes.margins(x=_STYLE["axes.xmargin"])
    for side in ("top", "right"):
        axes.spines[side].set_visible(_STYLE[f"axes.spines.{side}"])


def widen(axes: Any, least: float) -> None:
    """Show a range of at least `least`, so that rounding noise is a flat line."""
    low, high = axes.get_ylim()
    if high - low < least:
        middle = (low + high) / 2
        axes.set_ylim(middle - least / 2, middle + least / 2)


def flatten(axes: Any, least: float) -> None:
    """Show curves that vary by less than `least` as flat lines on a scale of one unit."""
    low, high = axes.dataLim.intervaly
    if high - low < least:
        middle = round((low + high) / 2, 3) + 0.0
        axes.set_ylim(middle - 1, middle + 1)
        axes.set_yticks([middle])


def make_figure(title: str, width: float, height: float, dpi: Optional[int] = None) -> Figure:
    """Make an empty figure; width and height in inches."""
    figure = Figure(figsize=(width, height), dpi=dpi or _STYLE["figure.dpi"])
    figure.set_label(title)
    figure.suptitle(
        title, x=0.1 / width, y=1 - 0.1 / height, ha="left", va="top", fontsize="medium"
    )
    return figure
