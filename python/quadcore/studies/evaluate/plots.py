"""Plots of an evaluation."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ...report.colours import PALETTE, curve_style
from ...report.decimation import pick_evenly
from ...report.plots import REFERENCE, dress, make_figure, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

from ...simulation.scenario_events import Event
from ..figures import Figures
from ..measured_flight import Outcome
from ..tracking_metrics import compute_errors, find_failure_time
from .evaluate import Evaluation
from .event_marks import mark_events
from .loop_plots import draw_loops
from .margins import RATES

_ROTOR_PANELS = 12  # in one figure
_BOXES = 40
_FLOOR = 1e-7  # m; errors below are drawn here, as a logarithmic axis would enlarge rounding noise
_ERROR = "tracking error (m), floor $10^{-7}$"
_GROUP = ("controller", "reference", "engine", "model", "scenario")
_MARGINS = {"left": 0.09, "right": 0.98, "bottom": 0.12}


class DrawnFlight(NamedTuple):
    """A flight in a figure."""

    label: str
    outcome: Outcome
    style: int
    """Number of its `curve_style`, the same in all figures and in the player."""
    row: int
    """Row of the table of the evaluation."""


Flights = List[DrawnFlight]
"""Flights that share a figure."""


def list_figures(
    evaluation: Evaluation, events: Optional[Mapping[str, Sequence[Event]]] = None
) -> Figures:
    """List the figures of an evaluation, in the order of the page.

    Parameters
    ----------
    evaluation
        Flights and statistics.
    events
        Events by scenario.
    """
    figures: Figures = {}
    for i, ((reference, scenario), flights) in enumerate(group_flights(evaluation).items(), 1):
        name = name_group(evaluation, reference, scenario)
        happening = (events or {}).get(scenario, ())
        figures[f"tracks_{i}"] = partial(_draw_tracks, name, flights)
        figures[f"errors_{i}"] = partial(_draw_errors, name, flights, happening)
        figures[f"rotors_{i}"] = partial(_draw_rotors, name, flights, happening)
        if any(flight.outcome.response is not None for flight in flights):
            figures[f"response_{i}"] = partial(_draw_responses, name, flights)
        if any(flight.outcome.spectra is not None for flight in flights):
            figures[f"spectra_{i}"] = partial(_draw_spectra, name, flights)
    if any(group["flights"] * (1 - group["failure_rate"]) > 1 for group in evaluation.groups):
        figures["seeds"] = partial(_draw_boxes, evaluation)
    if any(not row["failure"] for row in evaluation.loops):
        figures["loops"] = partial(_draw_loops, evaluation)
    if evaluation.margins:
        figures["margins"] = partial(_draw_margins, evaluation.margins)
        figures["rates"] = partial(_draw_rates, evaluation.margins, _style_margins(evaluation))
    return figures


def is_plot(name: str) -> bool:
    """Whether `list_figures` lists figures with that name."""
    return (
        re.fullmatch(r"(tracks|errors|rotors|response|spectra)_\d+|seeds|margins|rates|loops", name)
        is not None
    )


def make_label(row: Mapping[str, Any], rows: Any, kinds: Sequence[str] = _GROUP) -> str:
    """Label a row by the names that differ among the rows."""
    parts = [
        str(row[name])
        for name in kinds
        if name == "controller" or len({other[name] for other in rows}) > 1
    ]
    return ", ".join(part for part in parts if part)


def group_flights(evaluation: Evaluation) -> Dict[Tuple[str, str], Flights]:
    """Group the flights with logs by reference and scenario, and label them."""
    found: Dict[Tuple[str, str], Flights] = {}
    styles = _number_styles(evaluation)
    for row, outcome in evaluation.drawn.items():
        cells = evaluation.table[row]
        label = _name_curve(cells, evaluation)
        shown = label + " (failed)" * bool(outcome.failure)
        flight = DrawnFlight(shown, outcome, styles[label], row)
        found.setdefault((cells["reference"], cells["scenario"]), []).append(flight)
    return found


def name_group(evaluation: Evaluation, reference: str, scenario: str) -> str:
    """Name a group of `group_flights` for a title; of several seeds, the first one is shown."""
    has_scenarios = len({row["scenario"] for row in evaluation.table}) > 1
    name = f"{reference}, scenario {scenario}" if has_scenarios else reference
    seeds = [row["seed"] for row in evaluation.table]
    return f"{name}, seed {seeds[0]}" if len(set(seeds)) > 1 else name


def _name_curve(row: Mapping[str, Any], evaluation: Evaluation) -> str:
    return make_label(row, evaluation.table, ("controller", "engine", "model"))


def _number_styles(evaluation: Evaluation) -> Dict[str, int]:
    """Give each curve of controller, engine and model a number."""
    labels = dict.fromkeys(_name_curve(row, evaluation) for row in evaluation.table)
    return {label: number for number, label in enumerate(labels)}


def _rows_before_failure(outcome: Outcome) -> slice:
    """Return the rows before the vehicle diverges: later ones would set the scale of the axes."""
    assert outcome.log is not None
    end = find_failure_time(outcome.log)
    return slice(None if end is None else int(np.searchsorted(outcome.log.time, end)))


def _draw_tracks(name: str, flights: Flights) -> Figure:
    room = _header_height([flight.label for flight in flights])
    height = 3.6 + room
    figure = make_figure(f"Tracks: {name}", 8, height)
    margins = dict(_MARGINS, top=1 - room / height, bottom=0.5 / height, wspace=0.25)
    above, side = figure.subplots(1, 2, gridspec_kw=margins)
    reference = next(each.outcome.log.topics["reference"] for each in flights if each.outcome.log)
    for axes, (a, b) in ((above, "xy"), (side, "xz")):
        dress(axes)
        for label, outcome, style, _ in flights:
            assert outcome.log is not None
            at = dict(zip("xyz", outcome.log.position[_rows_before_failure(outcome)].T))
            axes.plot(at[a], at[b], label=label, linewidth=1.2, **curve_style(style))
        axes.plot(reference[a], reference[b], zorder=3, **REFERENCE)
        axes.set_xlabel(f"{a} (m)")
        axes.set_ylabel(f"{b} (m)")
        axes.set_aspect("equal", adjustable="datalim")
    _add_legend(figure, above)
    return figure


def _draw_errors(name: str, flights: Flights, events: Sequence[Event]) -> Figure:
    title = f"Tracking error: {name}"
    figure, grid = panels(
        title, 1, height=2.8, above=_header_height([flight.label for flight in flights])
    )
    axes = grid[0, 0]
    for label, outcome, style, _ in flights:
        assert outcome.log is not None
        rows = _rows_before_failure(outcome)
        errors = np.maximum(compute_errors(outcome.log)[rows], _FLOOR)
        axes.semilogy(
            outcome.log.time[rows], errors, label=label, linewidth=1, **curve_style(style)
        )
    axes.set_ylabel(_ERROR)
    axes.set_ylim(_FLOOR / 1.5, max(axes.get_ylim()[1], 1e4 * _FLOOR))
    _add_legend(figure, axes)
    mark_events(figure, events)
    return figure


def _draw_rotors(name: str, flights: Flights, events: Sequence[Event]) -> Figure:
    drawn = [flights[i] for i in pick_evenly(len(flights), _ROTOR_PANELS)]
    title = f"Rotor speed: {name}"
    if len(drawn) < len(flights):
        title += f" ({len(drawn)} of {len(flights)} flights)"
    count = max(outcome.log.rotor_velocity.shape[1] for _, outcome, _, _ in drawn if outcome.log)
    room = 0.15 + _header_height(["rotor 1"] * count)
    figure, grid = panels(title, len(drawn), height=1.3, above=room)
    for axes, (label, outcome, _, _) in zip(grid[:, 0], drawn):
        assert outcome.log is not None
        rows = _rows_before_failure(outcome)
        speeds = np.abs(outcome.log.rotor_velocity[rows])
        for i, speed in enumerate(speeds.T):
            axes.plot(
                outcome.log.time[rows], speed, linewidth=0.8, label=f"rotor {i + 1}",
                **curve_style(i),
            )  # fmt: skip
        if np.isfinite(outcome.limit):
            axes.axhline(outcome.limit, color="black", linestyle="--", linewidth=1, label="limit")
        axes.set_ylim(bottom=0)
        axes.set_title(label, loc="left", fontsize="small", pad=2)
        axes.set_ylabel("speed (rad/s)")
    _add_legend(figure, *grid[:, 0])
    mark_events(figure, events)
    return figure


def _draw_responses(name: str, flights: Flights) -> Figure:
    title = f"Estimated step response: {name}"
    figure, grid = panels(
        title, 1, height=2.8, above=_header_height([flight.label for flight in flights])
    )
    axes = grid[0, 0]
    for label, outcome, style, _ in flights:
        if outcome.response is not None:
            axes.plot(*outcome.response.T, label=label, linewidth=1.2, **curve_style(style))
    axes.axhline(1, **REFERENCE)
    axes.set_ylim(-0.2, 1.8)
    axes.set_ylabel("position / step (1)")
    axes.set_xlabel("time after the step (s)")
    _add_legend(figure, axes)
    return figure


def _draw_spectra(name: str, flights: Flights) -> Figure:
    above = _header_height([flight.label for flight in flights])
    figure, grid = panels(f"Power spectral densities: {name}", 2, height=2.2, above=above)
    for (axes,), (part, quantity) in zip(
        grid, (("rates", "angular velocity"), ("commands", "commanded rotor speed"))
    ):
        for label, outcome, style, _ in flights:
            if outcome.spectra is not None:
                density = getattr(outcome.spectra, part)[1:]
                frequencies = outcome.spectra.frequencies[1:]
                density = np.maximum(density, np.finfo(float).tiny)  # of a constant: 0
                axes.loglog(frequencies, density, label=label, linewidth=1, **curve_style(style))
        axes.set_ylabel(f"{quantity}\n((rad/s)$^2$/Hz)")
    grid[-1, 0].set_xlabel("frequency (Hz)")
    _add_legend(figure, *grid[:, 0])
    return figure


def _draw_boxes(evaluation: Evaluation) -> Figure:
    groups = [group for group in evaluation.groups if group["failure_rate"] < 1]
    drawn = [groups[i] for i in pick_evenly(len(groups), _BOXES)]
    height = 1.2 + 0.3 * len(drawn)
    title = "Maximum tracking error in the last 10 s: median, quartiles and range over the seeds"
    if len(drawn) < len(groups):
        title += f" ({len(drawn)} of {len(groups)} combinations)"
    figure = make_figure(title, 8, height)
    axes = figure.add_axes((0.4, 0.6 / height, 0.57, 1 - 1.1 / height))
    dress(axes)
    values, labels = [], []
    for group in reversed(drawn):
        errors = [
            max(row["final_position"], _FLOOR)
            for row in evaluation.table
            if all(row[name] == group[name] for name in _GROUP) and not row["failure"]
        ]
        values.append(errors)
        failed = round(group["failure_rate"] * group["flights"])
        labels.append(make_label(group, groups) + f", {failed} failed" * (failed > 0))
    axes.set_xscale("log")
    for place, errors in enumerate(values):
        low, left, middle, right, high = np.quantile(errors, [0, 0.25, 0.5, 0.75, 1])
        axes.plot([low, high], [place, place], color="black", marker="|", linewidth=1)
        axes.barh(place, right - left, left=left, height=0.6, color="white", edgecolor="black")
        axes.plot([middle, middle], [place - 0.3, place + 0.3], color=PALETTE[1])
    axes.set_xlim(min(map(min, values)) / 1.2, max(map(max, values)) * 1.2)
    axes.set_yticks(range(len(labels)))
    axes.set_yticklabels(labels, fontsize="small")
    axes.set_xlabel(_ERROR)
    return figure


def _draw_margins(rows: Any) -> Figure:
    height = 1.2 + 0.35 * len(rows)
    figure = make_figure("Gain and delay margins", 8, height)
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
    gain.set_xlabel("true thrust / modelled thrust (1)")
    delay.set_xlabel("delay margin (ms)")
    gain.set_yticks(places)
    gain.set_yticklabels([row["controller"] for row in rows], fontsize="small")
    return figure


def _draw_loops(evaluation: Evaluation) -> Figure:
    styles = _number_styles(evaluation)
    label = partial(_name_curve, evaluation=evaluation)
    figure = draw_loops(evaluation.loops, label, styles, _header_height(list(styles)))
    _add_legend(figure, *figure.axes)
    return figure


def _style_margins(evaluation: Evaluation) -> List[int]:
    """Return the numbers of the styles of the margins' rows, those of their controllers."""
    controllers = [row["controller"] for row in evaluation.table]
    styles = _number_styles(evaluation)
    firsts = [controllers.index(row["controller"]) for row in evaluation.margins]
    return [styles[_name_curve(evaluation.table[row], evaluation)] for row in firsts]


def _draw_rates(rows: Any, styles: Sequence[int]) -> Figure:
    room = _header_height([row["controller"] for row in rows])
    figure, grid = panels("RMS tracking error by update rate", 1, height=2.8, above=room)
    axes = grid[0, 0]
    for row, style in zip(rows, styles):
        errors = [row.get(f"rms_at_{rate:g}_Hz", np.nan) for rate in RATES]
        axes.loglog(
            RATES,
            np.maximum(errors, _FLOOR),
            marker="o",
            label=row["controller"],
            **curve_style(style),
        )
    axes.set_xlabel("update rate (Hz)")
    axes.set_ylabel(f"RMS {_ERROR}")
    _add_legend(figure, axes)
    return figure


def _columns(labels: Sequence[str]) -> int:
    """Return the number of columns of a legend."""
    return max(1, min(6, 90 // (6 + max(map(len, labels), default=1))))


def _header_height(labels: Sequence[str]) -> float:
    """Return the height of title and legend of some curves and a reference, inches."""
    labels = [*labels, "reference"]
    return 0.45 + 0.2 * -(-len(labels) // _columns(labels))


def _add_legend(figure: Figure, *axes: Any) -> None:
    """Add a legend of all curves of some panels, each label once."""
    entries = {
        label: handle for each in axes for handle, label in zip(*each.get_legend_handles_labels())
    }
    figure.legend(
        list(entries.values()),
        list(entries),
        loc="upper left",
        bbox_to_anchor=(0, 1 - 0.25 / figure.get_figheight()),
        ncol=_columns(list(entries)),
        frameon=False,
        fontsize="small",
    )
