"""Pictures of an evaluation."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ...report.colours import PALETTE
from ...report.plots import dress, make_figure, panels, png
from ...report.thinning import pick_evenly

if TYPE_CHECKING:
    from matplotlib.figure import Figure

from ...simulation.scenario_events import Event
from ..flights import Outcome
from ..measures import distance, lost
from .evaluate import Evaluation
from .event_marks import mark
from .robustness import RATES

_CURVES = 16  # in one panel; more cannot be told apart
_PANELS = 9  # of rotor speeds; of more flights, evenly many
_STYLES = ("-", "--", ":", "-.")


def draw(
    evaluation: Evaluation, events: Optional[Mapping[str, Sequence[Event]]] = None
) -> Dict[str, bytes]:
    """Draw all pictures: PNG by name, in the order in which they are looked at.

    Parameters
    ----------
    evaluation
        What was flown.
    events
        What happens in it, by scenario.
    """
    figures: Dict[str, Figure] = {}
    for i, (reference, flights) in enumerate(by_reference(evaluation).items(), start=1):
        figures[f"tracks_{i}"] = _tracks(reference, flights)
        figures[f"errors_{i}"] = _errors(reference, flights)
        figures[f"rotors_{i}"] = _rotors(reference, flights)
        for name in ("errors", "rotors"):
            mark(figures[f"{name}_{i}"], events or {})
        if any(outcome.response is not None for _, outcome in flights):
            figures[f"response_{i}"] = _responses(reference, flights)
    if any(group["flights"] * (1 - group["failure_rate"]) > 1 for group in evaluation.groups):
        figures["seeds"] = _boxes(evaluation)
    if evaluation.margins:
        figures["margins"] = _margins(evaluation.margins)
        figures["rates"] = _rates(evaluation.margins)
    return {name: png(figure) for name, figure in figures.items()}


def is_picture(name: str) -> bool:
    """Whether `draw` makes pictures of that name."""
    return (
        re.fullmatch(r"(tracks|errors|rotors|response)_\d+|seeds|margins|rates", name) is not None
    )


Flights = List[Tuple[str, Outcome]]


def label(row: Dict[str, Any], among: Any) -> str:
    """Name a flight by what sets it apart from the others."""
    parts = [
        str(row[name])
        for name in ("controller", "engine", "model", "scenario")
        if name == "controller" or len({other[name] for other in among}) > 1
    ]
    return ", ".join(part for part in parts if part)


def by_reference(evaluation: Evaluation) -> Dict[str, Flights]:
    """Name the flights that are drawn, by their reference."""
    found: Dict[str, Flights] = {}
    for row, outcome in evaluation.drawn.items():
        cells = evaluation.table[row]
        named = label(cells, evaluation.table)
        if outcome.failure:
            named += " (lost)" if outcome.failure.startswith("lost") else " (failed)"
        found.setdefault(cells["reference"], []).append((named, outcome))
    return found


def _held(outcome: Outcome) -> int:
    """Count the rows until the vehicle is lost: what it does then hides what the others do."""
    assert outcome.log is not None
    end = lost(outcome.log)
    return len(outcome.log) if end is None else int(np.searchsorted(outcome.log.time, end))


def _look(i: int) -> Dict[str, Any]:
    return {"color": PALETTE[i % len(PALETTE)], "linestyle": _STYLES[i // len(PALETTE) % 4]}


def _tracks(reference: str, flights: Flights) -> Figure:
    room = _above(flights)
    height = 3.6 + room
    figure = make_figure(f"Tracks: {reference}", 8, height)
    margins = dict(_MARGINS, top=1 - room / height, bottom=0.5 / height, wspace=0.25)
    above, side = figure.subplots(1, 2, gridspec_kw=margins)
    wanted = next(outcome.log.topics["reference"] for _, outcome in flights if outcome.log)
    for axes, (a, b) in ((above, "xy"), (side, "xz")):
        dress(axes)
        for i, (named, outcome) in enumerate(flights[:_CURVES]):
            assert outcome.log is not None
            at = dict(zip("xyz", outcome.log.position[: _held(outcome)].T))
            axes.plot(at[a], at[b], label=named, linewidth=1.2, **_look(i))
        axes.plot(wanted[a], wanted[b], color="0.5", linewidth=0.8, label="reference", zorder=0)
        axes.set_xlabel(f"{a} (m)")
        axes.set_ylabel(f"{b} (m)")
        axes.set_aspect("equal", adjustable="datalim")
    _legend(figure, above)
    return figure


def _errors(reference: str, flights: Flights) -> Figure:
    title = f"Distance to the reference: {reference}"
    figure, grid = panels(title, 1, height=2.8, above=_above(flights))
    axes = grid[0, 0]
    for i, (named, outcome) in enumerate(flights[:_CURVES]):
        assert outcome.log is not None
        # A logarithm has no 0, which is where a flight begins.
        rows = slice(_held(outcome))
        away = np.maximum(distance(outcome.log)[rows], 1e-7)
        axes.semilogy(outcome.log.time[rows], away, label=named, linewidth=1, **_look(i))
    axes.set_ylabel("distance (m)")
    _legend(figure, axes)
    return figure


def _rotors(reference: str, flights: Flights) -> Figure:
    shown = [flights[i] for i in pick_evenly(len(flights), _PANELS)]
    title = f"Speeds of the rotors and their limit: {reference}"
    figure, grid = panels(title, len(shown), height=1.3)
    for axes, (named, outcome) in zip(grid[:, 0], shown):
        assert outcome.log is not None
        rows = slice(_held(outcome))
        speeds = np.abs(outcome.log.rotor_velocity[rows])
        for i, speed in enumerate(speeds.T):
            axes.plot(outcome.log.time[rows], speed, color=PALETTE[i % len(PALETTE)], linewidth=0.8)
        if np.isfinite(outcome.limit):
            axes.axhline(outcome.limit, color="black", linestyle="--", linewidth=1)
        axes.set_ylim(bottom=0)
        axes.set_title(named, loc="left", fontsize="small", pad=2)
        axes.set_ylabel("rad/s")
    return figure


def _responses(reference: str, flights: Flights) -> Figure:
    title = f"Step response estimated from the flight: {reference}"
    figure, grid = panels(title, 1, height=2.8, above=_above(flights))
    axes = grid[0, 0]
    for i, (named, outcome) in enumerate(flights[:_CURVES]):
        if outcome.response is not None:
            axes.plot(*outcome.response.T, label=named, linewidth=1.2, **_look(i))
    axes.axhline(1, color="0.5", linewidth=0.8)
    axes.set_ylim(-0.2, 1.8)
    _legend(figure, axes)
    return figure


def _boxes(evaluation: Evaluation) -> Figure:
    groups = [group for group in evaluation.groups if group["failure_rate"] < 1][:40]
    height = 1.2 + 0.3 * len(groups)
    figure = make_figure("Largest error of the last 10 s over the seeds", 8, height)
    axes = figure.add_axes((0.4, 0.6 / height, 0.57, 1 - 1.1 / height))
    dress(axes)
    values, names = [], []
    for group in reversed(groups):
        found = [
            row["final_position"]
            for row in evaluation.table
            if all(row[name] == group[name] for name in _GROUP) and not row["failure"]
        ]
        values.append(found)
        lost = round(group["failure_rate"] * group["flights"])
        names.append(
            f"{label(group, groups)}, {group['reference']}" + f", {lost} failed" * (lost > 0)
        )
    axes.set_xscale("log")
    for place, found in enumerate(values):
        low, left, middle, right, high = np.quantile(found, [0, 0.25, 0.5, 0.75, 1])
        axes.plot([low, high], [place, place], color="black", marker="|", linewidth=1)
        axes.barh(place, right - left, left=left, height=0.6, color="white", edgecolor="black")
        axes.plot([middle, middle], [place - 0.3, place + 0.3], color=PALETTE[1])
    axes.set_xlim(min(map(min, values)) / 1.2, max(map(max, values)) * 1.2)
    axes.set_yticks(range(len(names)))
    axes.set_yticklabels(names, fontsize="small")
    axes.set_xlabel("distance (m); box: quartiles, whiskers: all seeds")
    return figure


def _margins(rows: Any) -> Figure:
    height = 1.2 + 0.35 * len(rows)
    figure = make_figure("What a controller forgives", 8, height)
    gain, delay = figure.subplots(
        1, 2, sharey=True, gridspec_kw=dict(_MARGINS, left=0.28, top=0.8, bottom=0.6 / height)
    )
    places = np.arange(len(rows))[::-1]
    for place, row in zip(places, rows):
        low, high = row.get("gain_low", np.nan), row.get("gain_high", np.nan)
        gain.barh(place, np.log10(high / low), left=np.log10(low), height=0.6, color=PALETTE[0])
        delay.barh(place, 1e3 * row.get("delay_margin", np.nan), height=0.6, color=PALETTE[1])
    for axes in (gain, delay):
        dress(axes)
    gain.axvline(0, color="black", linewidth=0.8)
    ticks = np.array([0.1, 0.2, 0.5, 1, 2, 5, 10])
    gain.set_xticks(np.log10(ticks))
    gain.set_xticklabels([f"{tick:g}" for tick in ticks])
    gain.set_xlabel("thrust, of what is believed")
    delay.set_xlabel("delay (ms)")
    gain.set_yticks(places)
    gain.set_yticklabels([row["controller"] for row in rows], fontsize="small")
    return figure


def _rates(rows: Any) -> Figure:
    room = _above([(row["controller"], None) for row in rows])
    figure, grid = panels("RMS error by the controller's rate", 1, height=2.8, above=room)
    axes = grid[0, 0]
    for i, row in enumerate(rows):
        errors = [row.get(f"rms_at_{rate:g}_Hz", np.nan) for rate in RATES]
        axes.loglog(RATES, errors, marker="o", label=row["controller"], **_look(i))
    axes.set_xlabel("rate (1/s)")
    axes.set_ylabel("RMS distance (m)")
    _legend(figure, axes)
    return figure


_GROUP = ("controller", "reference", "engine", "model", "scenario")
_MARGINS = {"left": 0.09, "right": 0.98, "bottom": 0.12}


def _columns(labels: Sequence[str]) -> int:
    """How many entries of a legend stand side by side."""
    return max(1, min(4, 90 // (6 + max(map(len, labels), default=1))))


def _above(flights: Sequence[Tuple[str, Any]]) -> float:
    """Room for title and legend, inches."""
    labels = [named for named, _ in flights[:_CURVES]] + ["reference"]
    return 0.45 + 0.2 * -(-len(labels) // _columns(labels))


def _legend(figure: Figure, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc="upper left",
        bbox_to_anchor=(0, 1 - 0.25 / figure.get_figheight()),
        ncol=_columns(labels),
        frameon=False,
        fontsize="small",
    )
