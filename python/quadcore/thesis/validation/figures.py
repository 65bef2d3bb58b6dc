"""Figures of a study: those of chapter 6.1, and those of `cause_plots`."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, NamedTuple, Sequence, Tuple

import numpy as np

from ...report.colours import PALETTE
from ...report.drawing import Drawing
from ...report.plots import finish, make_figure, subplots, widen
from .cause_plots import draw_chains, draw_damping
from .experiment import MODEL, Case
from .states import extract_states
from .study import Study
from .thesis_figures import KINDS, thesis_figures

_MODEL = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 1.1, "label": "model"}
_DPI = 100


class Curves(NamedTuple):
    """Data for the figures of one drag."""

    drag: str
    engines: List[str]
    sim_slow: List[float]
    time: np.ndarray
    model: np.ndarray
    """States of the model, shape (rows, 12)."""
    plants: Dict[Tuple[str, float], np.ndarray]


def collect_curves(study: Study, drag: str) -> Curves:
    """Collect the flights of one drag; failed flights are omitted.

    Raises
    ------
    KeyError
        If the flight of the model failed.
    """
    flown = {
        (case.plant, case.sim_slow): flight.log
        for case, flight in study.flights.items()
        if flight.log is not None and case.drag == drag and not case.variant
    }
    model = flown.pop((MODEL, 1.0))
    plants = {key: extract_states(log) for key, log in flown.items() if key[1] in study.sim_slow}
    return Curves(drag, study.engines, study.sim_slow, model.time, extract_states(model), plants)


def draw(what: Curves, kind: str) -> Drawing:
    """Draw a figure of chapter 6 with a column per engine and a line per slowdown."""
    title, columns, labels, scale, error, least = KINDS[kind]
    title = f"{title}, drag: {what.drag}"
    numbers = thesis_figures(what.drag, kind, what.sim_slow)
    if numbers:
        title += f" (thesis: {numbers})"
    figure, panels = _make_panels(title, 3, len(what.engines), "none" if error else "row")
    for engine, column in zip(what.engines, panels.T):
        column[0].set_title(engine, fontsize="medium")
        for i, (n, colour) in enumerate(zip(what.sim_slow, _cycle(what.sim_slow))):
            flown = what.plants.get((engine, n))
            if flown is None:
                continue
            shown = (flown - what.model if error else flown)[:, columns] * scale
            label = f"{n:g}" if i else f"sim_slow {n:g}"
            # Later curves are thinner, so that coinciding curves remain visible.
            width = 1.2 + 1.2 * (len(what.sim_slow) - 1 - i)
            for axes, curve in zip(column, shown.T):
                axes.plot(what.time, curve, color=colour, linewidth=width, label=label)
        if not error:
            for axes, curve in zip(column, what.model[:, columns].T * scale):
                axes.plot(what.time, curve, **_MODEL)
    for axes in panels.flat:
        widen(axes, least)
    for axes, label in zip(panels[:, 0], labels):
        axes.set_ylabel(label)
    for axes in panels[-1]:
        axes.set_xlabel("time (s)")
    _add_legend(figure, panels.flat)
    return finish(figure)


def draw_commands(commands: np.ndarray, duration: float) -> Drawing:
    """Draw the commands."""
    n = commands.shape[1] - 1
    title = "Input: magnitude of the rotors' speeds (rad/s)"
    figure, panels = _make_panels(title, n, 1, "all", each=0.8, width=9, above=0.4)
    time = np.append(commands[:, 0], duration)
    for i, (axes, speeds) in enumerate(zip(panels[:, 0], np.abs(commands[:, 1:]).T), 1):
        axes.step(time, np.append(speeds, speeds[-1]), where="post", color="black", linewidth=1.2)
        axes.set_ylabel(f"rotor {i}")
    panels[-1, 0].set_xlabel("time (s)")
    panels[-1, 0].set_xlim(0, duration)
    return finish(figure)


def list_figures(study: Study) -> Dict[str, Tuple[Callable[..., Drawing], Tuple[Any, ...]]]:
    """List every figure of a study by name, as a function with its arguments."""
    result: Dict[str, Tuple[Callable[..., Drawing], Tuple[Any, ...]]] = {
        "commands": (draw_commands, (study.experiment.commands, study.experiment.plan.duration)),
    }
    if study.damping:
        result["damping"] = draw_damping, (study.damping,)
    for drag in study.drags:
        chains = [chain for chain in study.chains if chain.drag == drag]
        if study.flights[Case(MODEL, 1.0, drag)].log is None:
            continue
        if any(chain.links for chain in chains):
            result[f"chain_{drag}"] = (draw_chains, (chains,))
        result.update(
            (f"{kind}_{drag}", (draw, (collect_curves(study, drag), kind))) for kind in KINDS
        )
    return result


def _make_panels(
    title: str,
    rows: int,
    columns: int,
    sharey: str,
    each: float = 1.5,
    width: float = 0.0,
    above: float = 0.85,
) -> Any:
    """Make rows x columns panels of height `each` (inches), with space for title and legend."""
    width, below = width or max(2.6 * columns + 1.2, 6), 0.45
    height = above + each * rows + below
    figure = make_figure(title, width, height, _DPI)
    # Fixed margins, because matplotlib's automatic layouts differ between versions.
    margins = {
        "left": 1.1 / width,
        "right": 1 - 0.2 / width,
        "top": 1 - above / height,
        "bottom": below / height,
        "hspace": 0.22,
        "wspace": 0.1 if sharey == "row" else 0.3,
    }
    shared: Any = {"sharex": True, "sharey": sharey}
    panels = subplots(figure, rows, columns, margins, **shared)
    for axes in panels.flat:
        axes.locator_params(axis="x", nbins=4 if columns > 1 else 10, steps=[1, 2, 5, 10])
    return figure, panels


def _add_legend(figure: Any, panels: Any) -> None:
    named: Dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            named.setdefault(label, handle)
    figure.legend(
        list(named.values()),
        list(named),
        loc="upper left",
        bbox_to_anchor=(0.0, 1 - 0.25 / figure.get_figheight()),
        ncol=max(1, len(named)),
        frameon=False,
        fontsize="small",
        handlelength=1.2,
        columnspacing=1.0,
    )


def _cycle(items: Sequence[Any]) -> List[str]:
    return [PALETTE[i % len(PALETTE)] for i in range(len(items))]
