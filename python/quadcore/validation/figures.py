"""The figures of chapter 6, and those that say why."""

from __future__ import annotations

import textwrap
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from ..plots import PALETTE, dress, png, titled
from .chain import Chain, Link
from .damping import Damping
from .experiment import MODEL, Case
from .states import states
from .study import Study

_MODEL = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 1.1, "label": "model"}
_DPI = 100
_NOTHING = 1e-9  # 1/s; a decay that is none


class Kind(NamedTuple):
    """One of the five figures that chapter 6 shows for each drag."""

    title: str
    columns: slice
    """Of the states."""
    labels: Tuple[str, str, str]
    scale: float
    error: bool


_ANGLES = (r"$\phi$ (deg)", r"$\theta$ (deg)", r"$\psi$ (deg)")
_RATES = (r"$\dot\phi$ (deg/s)", r"$\dot\theta$ (deg/s)", r"$\dot\psi$ (deg/s)")
KINDS: Mapping[str, Kind] = {
    "position": Kind("Position", slice(0, 3), ("x (m)", "y (m)", "z (m)"), 1, False),
    "error": Kind(
        "Distance from the model", slice(0, 3), ("$e_x$ (m)", "$e_y$ (m)", "$e_z$ (m)"), 1, True
    ),
    "attitude": Kind("Attitude", slice(3, 6), _ANGLES, float(np.degrees(1)), False),
    "velocity": Kind(
        "Velocity", slice(6, 9), (r"$\dot x$ (m/s)", r"$\dot y$ (m/s)", r"$\dot z$ (m/s)"), 1, False
    ),
    "rates": Kind("Rates of the attitude", slice(9, 12), _RATES, float(np.degrees(1)), False),
}


class Curves(NamedTuple):
    """What the figures of one drag draw."""

    drag: str
    engines: List[str]
    sim_slow: List[float]
    time: np.ndarray
    model: np.ndarray
    """(rows, 12)"""
    plants: Dict[Tuple[str, float], np.ndarray]


def curves(study: Study, drag: str) -> Curves:
    """Collect the flights of one drag; those that failed are not among them.

    Raises
    ------
    KeyError
        The model's own flight failed.
    """
    flown = {
        (case.plant, case.sim_slow): flight.log
        for case, flight in study.flights.items()
        if flight.log is not None and case.drag == drag and not case.variant
    }
    model = flown.pop((MODEL, 1.0))
    plants = {key: states(log) for key, log in flown.items() if key[1] in study.sim_slow}
    return Curves(drag, study.engines, study.sim_slow, model.time, states(model), plants)


def draw(what: Curves, kind: str) -> bytes:
    """Draw a figure of chapter 6: engines side by side, slow-downs overlaid."""
    title, columns, labels, scale, error = KINDS[kind]
    figure, panels = _panels(
        f"{title}, drag: {what.drag}", 3, len(what.engines), "none" if error else "row"
    )
    for engine, column in zip(what.engines, panels.T):
        column[0].set_title(engine, fontsize="medium")
        for i, (n, colour) in enumerate(zip(what.sim_slow, _cycle(what.sim_slow))):
            flown = what.plants.get((engine, n))
            if flown is None:
                continue
            shown = (flown - what.model if error else flown)[:, columns] * scale
            # Curves that lie on each other: the later are the thinner.
            width = 1.2 + 1.2 * (len(what.sim_slow) - 1 - i)
            for axes, curve in zip(column, shown.T):
                axes.plot(what.time, curve, color=colour, linewidth=width, label=f"sim_slow {n:g}")
        if not error:
            for axes, curve in zip(column, what.model[:, columns].T * scale):
                axes.plot(what.time, curve, **_MODEL)
    for axes, label in zip(panels[:, 0], labels):
        axes.set_ylabel(label)
    for axes in panels[-1]:
        axes.set_xlabel("time (s)")
    _legend(figure, panels.flat)
    return png(figure)


def draw_commands(commands: np.ndarray, duration: float) -> bytes:
    """Draw the input."""
    n = commands.shape[1] - 1
    figure, panels = _panels("Input: magnitude of the rotors' speeds (rad/s)", n, 1, "all", 0.8, 9)
    time = np.append(commands[:, 0], duration)
    for i, (axes, speeds) in enumerate(zip(panels[:, 0], np.abs(commands[:, 1:]).T), 1):
        axes.step(time, np.append(speeds, speeds[-1]), where="post", color="black", linewidth=1.2)
        axes.set_ylabel(f"rotor {i}")
    panels[-1, 0].set_xlabel("time (s)")
    panels[-1, 0].set_xlim(0, duration)
    return png(figure)


def draw_chains(chains: Sequence[Chain]) -> bytes:
    """Draw what each link of the chains of one drag costs."""
    links = [link for chain in chains for link in chain.links]
    # All chains share what follows the slow-down.
    links.sort(key=lambda link: link.begin.sim_slow == link.end.sim_slow)
    sizes = {_name(link): link.largest for link in links}
    height = 1.0 + 0.42 * len(sizes)
    figure = titled(f"What each change moves, drag: {chains[0].drag}", 9, height, _DPI)
    axes = figure.add_axes((0.35, 0.55 / height, 0.62, 1 - 0.95 / height))
    dress(axes)
    values = [max(size, 1e-9) for size in sizes.values()]
    axes.barh(range(len(sizes)), values, 0.6, color=PALETTE[0])
    for row, value in enumerate(values):
        axes.text(value, row, f" {value:.3g} m", va="center", fontsize="small")
    axes.set_xscale("log")
    axes.set_xlim(min(values) / 3, max(values) * 8)
    axes.set_yticks(range(len(sizes)))
    axes.set_yticklabels([textwrap.fill(name, 40) for name in sizes], fontsize="small")
    axes.invert_yaxis()
    axes.set_xlabel("largest distance between the two flights (m)")
    return png(figure)


def _name(link: Link) -> str:
    """Say from which slow-down a change begins, if it is that of slow-down."""
    slow = link.begin.sim_slow
    return link.change if slow == link.end.sim_slow else f"{link.change} (from sim_slow {slow:g})"


def draw_damping(damping: Sequence[Damping]) -> bytes:
    """Draw the decay of a pitch rate that nothing should stop."""
    figure = titled("Decay of a pitch rate in free fall, without air", 6.4, 3.4, _DPI)
    axes = figure.add_axes((0.12, 0.16, 0.85, 0.72))
    dress(axes)
    slow = np.unique([entry.sim_slow for entry in damping])
    line = damping[0].expected * (damping[0].sim_slow / slow) ** 2
    label = r"$\sum (I_{zz}-I_{xx}) W^2 \Delta t\,/\,2J$"
    axes.plot(slow, line, color="0.5", linewidth=1, label=label)
    engines = list(dict.fromkeys(entry.engine for entry in damping))
    for engine, colour, mark in zip(engines, _cycle(engines), "osD"):
        rows = [row for row in damping if row.engine == engine and abs(row.measured) > _NOTHING]
        name = engine if rows else f"{engine}: below {_NOTHING:g}"
        shown = ([row.sim_slow for row in rows], [abs(row.measured) for row in rows])
        axes.plot(*shown, mark, color=colour, label=name)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(slow)
    axes.set_xticklabels([f"{n:g}" for n in slow])
    axes.minorticks_off()
    axes.margins(x=0.04)
    axes.set_ylim(_NOTHING, 3 * max(line))
    axes.set_xlabel("sim_slow")
    axes.set_ylabel("decay (1/s)")
    axes.legend(loc="lower left", frameon=False, fontsize="small")
    return png(figure)


def pictures(study: Study) -> Dict[str, Tuple[Callable[..., bytes], Tuple[Any, ...]]]:
    """Every picture of a study by name, as a function and what to call it with."""
    result: Dict[str, Tuple[Callable[..., bytes], Tuple[Any, ...]]] = {
        "commands": (draw_commands, (study.experiment.commands, study.experiment.duration)),
    }
    if study.damping:
        result["damping"] = draw_damping, (study.damping,)
    for drag in study.drags:
        chains = [chain for chain in study.chains if chain.drag == drag]
        if study.flights[Case(MODEL, 1.0, drag)].log is None:
            continue
        result[f"chain_{drag}"] = (draw_chains, (chains,))
        result.update((f"{kind}_{drag}", (draw, (curves(study, drag), kind))) for kind in KINDS)
    return result


def _panels(
    title: str, rows: int, columns: int, sharey: str, each: float = 1.5, width: float = 0.0
) -> Any:
    width, above, below = width or 2.6 * columns + 1.2, 0.55, 0.45  # inch
    height = above + each * rows + below
    figure = titled(title, width, height, _DPI)
    # Fixed margins: matplotlib's automatic layouts differ from version to version.
    margins = {
        "left": 0.75 / width,
        "right": 1 - 0.2 / width,
        "top": 1 - above / height,
        "bottom": below / height,
        "hspace": 0.12,
        "wspace": 0.08 if sharey == "row" else 0.3,
    }
    shared: Any = {"sharex": True, "sharey": sharey}
    panels = figure.subplots(rows, columns, squeeze=False, gridspec_kw=margins, **shared)
    for axes in panels.flat:
        dress(axes)
    figure.align_ylabels(panels)
    return figure, panels


def _legend(figure: Any, panels: Any) -> None:
    named: Dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            named.setdefault(label, handle)
    figure.legend(
        list(named.values()),
        list(named),
        loc="upper right",
        ncol=max(1, len(named)),
        frameon=False,
        fontsize="small",
        handlelength=1.2,
        columnspacing=1.0,
    )


def _cycle(items: Sequence[Any]) -> List[str]:
    return [PALETTE[i % len(PALETTE)] for i in range(len(items))]
