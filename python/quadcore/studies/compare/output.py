"""Files of a comparison: table, plots and page."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ...model.obstacles import draw_world, join_worlds
from ...model.visuals import read_vehicle
from ...report.decimation import pick_evenly
from ...report.drawing import Drawing, save_drawings
from ..figures import draw_figures
from ..flight_folder import DOCUMENT, WrittenFlight, remove_flights, write_flights
from ..output_folder import remove_listed_files
from ..table import (
    choose_display_unit,
    count_outcomes,
    format_number,
    make_csv,
    make_json,
    save_files,
)
from .plan import Plan
from .result import Comparison

_ROWS_OF_PAGE = 200
_DRAWN = 40  # maximum number of flights in a plot
_CONDITIONS = ("engine", "controller", "reference", "commands", "scenario", "duration")


def pick_drawn(count: int) -> List[int]:
    """Return the rows to draw: all, or evenly spaced rows that include the first and the last."""
    return pick_evenly(count, _DRAWN)


FILES = ("table.csv", "comparison.json", DOCUMENT, "report.html")


def log_name(row: int, count: int) -> str:
    """Return the path of a flight's log within the folder; `count` is the number of flights."""
    return f"logs/{row + 1:0{len(str(count))}}.csv"


def remove_logs(folder: Path) -> None:
    """Remove the logs and models of an earlier comparison."""
    remove_flights(folder)
    remove_listed_files(
        folder, "comparison.json", "logs", re.compile(r"logs/[0-9]+\.csv").fullmatch
    )


def write(
    comparison: Comparison,
    plan: Plan,
    flight: Mapping[str, str],
    folder: Path,
    plots: bool,
    has_logs: bool,
) -> List[Path]:
    """Write ``table.csv``, ``comparison.json``, ``report.html`` and plots.

    Parameters
    ----------
    comparison
        Results, in which `logs` contains the decimated logs of the drawn flights.
    plan
        Plan of the comparison.
    flight
        Conditions that all flights share, for the page.
    folder
        Existing folder.
    plots
        Whether to draw plots.
    has_logs
        Whether the logs of the flights were written.
    """
    from ...report.page import write_page  # jinja2 is slow to import

    # The tables come first, because drawing is slow and can fail.
    tables = {
        "table.csv": make_csv(_table_rows(comparison)),
        "comparison.json": make_json(_make_content(comparison, flight, has_logs)),
    }
    written = save_files(folder, tables)
    written += write_flights(folder, _list_flights(comparison, plan) if has_logs else [])
    images = _draw_plots(comparison, plan) if plots else {}
    written += save_drawings(folder, images)
    page = folder / "report.html"
    values = _page_values(comparison, plan, flight, images)
    write_page(page, "compare.html", **values, player=_make_player(comparison, plan, plots))
    return [*written, page]


def summarise(comparison: Comparison) -> str:
    """Return the numbers of successful and failed flights in one line."""
    return count_outcomes(comparison.table["failure"].tolist())


def _draw_plots(comparison: Comparison, plan: Plan) -> Dict[str, Drawing]:
    from . import plots  # matplotlib is slow to import

    curves, against = [], None
    for row, (log, variant) in enumerate(zip(comparison.logs, plan)):
        if log is not None:
            curves.append(plots.Curve(plan.make_label(variant), log))
            against = curves[-1] if row == comparison.against else against
    if against is None:
        return {}
    figures = plots.list_figures(curves, against.log, against.label)
    return draw_figures(figures, plan.options.processes)


def _list_flights(comparison: Comparison, plan: Plan) -> List[WrittenFlight]:
    """List the flights that have a log."""
    return [
        WrittenFlight(plan.make_label(case), log_name(row, len(plan)), flown.model, flown.world)
        for row, (case, failure) in enumerate(zip(plan, comparison.table["failure"]))
        if not failure
        for flown in [plan.make_plan_without_controller(case)]
    ]


def _make_player(comparison: Comparison, plan: Plan, plots: bool) -> str:
    """Make an animation of the drawn flights; "" without any."""
    from ...report.player import PlayerFlight, make_section

    shown, worlds = [], []
    for log, case in zip(comparison.logs, plan):
        if plots and log is not None and len(log):
            flown = plan.make_plan_without_controller(case)
            shown.append(PlayerFlight(plan.make_label(case), log, read_vehicle(flown.model)))
            worlds.append(draw_world(flown.world))
    return make_section(shown, join_worlds(worlds)) if shown else ""


def _table_rows(comparison: Comparison) -> Iterable[Sequence[Any]]:
    yield ["number", *(comparison.table.dtype.names or ())]
    for number, row in enumerate(comparison.table.tolist(), start=1):
        yield [number, *row]


def _make_content(
    comparison: Comparison, flight: Mapping[str, str], has_logs: bool
) -> Dict[str, Any]:
    names = comparison.table.dtype.names or ()
    flown = [row for row, reason in enumerate(comparison.table["failure"]) if not reason]
    return {
        "logs": [log_name(row, len(comparison.table)) for row in flown if has_logs],
        "flight": dict(flight),
        "differences": {
            model: [difference._asdict() for difference in found]
            for model, found in comparison.differences.items()
        },
        "units": comparison.states,
        "against": _baseline_number(comparison),
        "rows": [
            {"number": number, **dict(zip(names, row))}
            for number, row in enumerate(comparison.table.tolist(), start=1)
        ],
    }


def _baseline_number(comparison: Comparison) -> Optional[int]:
    return None if comparison.against is None else comparison.against + 1


def _page_values(
    comparison: Comparison, plan: Plan, flight: Mapping[str, str], images: Mapping[str, Drawing]
) -> Dict[str, Any]:
    units = {state: choose_display_unit(unit) for state, unit in comparison.states.items()}
    rows = []
    guided = plan.control.is_closed_loop
    for number, (row, variant) in enumerate(zip(comparison.table, plan), start=1):
        if number > _ROWS_OF_PAGE:
            break
        errors = [format_number(row[f"{kind}_error"]) for kind in ("max", "rms") if guided]
        cells = {
            kind: {
                state: format_number(row[f"{kind}_{state}"] * factor)
                for state, (_, factor) in units.items()
            }
            for kind in ("final", "max")
        }
        label = plan.make_label(variant)
        head = {"number": number, "label": label, "failure": row["failure"], "errors": errors}
        rows.append({**head, **cells})
    shown = len(pick_drawn(len(plan)))
    return {
        "title": "Comparison of flights",
        "summary": summarise(comparison),
        "conditions": _describe_conditions(flight, plan),
        "verdict": _describe_largest(comparison, plan),
        "flight": flight,
        "differences": comparison.differences,
        "first": plan.models[0],
        "guided": guided,
        "axes": [
            {
                "name": axis.name,
                "listed": format_values(axis.values),
                "written": plan.format_written_value(axis),
            }
            for axis in plan.axes
        ],
        "plots": [{"name": name, "data": data} for name, data in images.items()],
        "omitted": f"The plots show {shown} of {len(plan)} flights." if shown < len(plan) else "",
        "against": comparison.against is not None and f"no. {_baseline_number(comparison)}",
        "units": {state: unit for state, (unit, _) in units.items()},
        "groups": _group_states(list(comparison.states)),
        "rows": rows,
        "more": max(0, len(plan) - _ROWS_OF_PAGE),
    }


def _describe_conditions(flight: Mapping[str, str], plan: Plan) -> str:
    """Describe the shared conditions of all flights in one line, for the head of the page."""
    kind = "Models" if len(plan.models) > 1 else "Model"
    shared = [f"{name} {flight[name]}" for name in _CONDITIONS if name in flight]
    varied = [f"{axis.name} {format_values(axis.values)}" for axis in plan.axes]
    return "; ".join([f"{kind} {', '.join(plan.models)}", *shared, *varied]) + "."


def _describe_largest(comparison: Comparison, plan: Plan) -> str:
    """Name the flight that differs most in position from the baseline."""
    state = next(iter(comparison.states))
    values = comparison.table[f"max_{state}"].astype(float)
    if comparison.against is None or not np.isfinite(values).any():
        return "No flight succeeded."
    row = int(np.nanargmax(np.where(np.isfinite(values), values, np.nan)))
    if values[row] == 0:
        return "All flights are bit-identical."
    unit, factor = choose_display_unit(comparison.states[state])
    label = next(plan.make_label(variant) for i, variant in enumerate(plan) if i == row)
    size = format_number(values[row] * factor)
    return (
        f"{label} differs most from no. {comparison.against + 1}: {state} by up to {size} {unit}."
    )


def _group_states(states: Sequence[str]) -> List[Tuple[str, Sequence[str]]]:
    """Split the states into tables that fit the page: norms, then components."""
    parts = [states[4:7], states[7:10], states[10:13], states[13:16], states[16:]]
    return [("", states[:4]), *zip((*states[:4], "rotors"), parts)]


def format_values(values: Any) -> str:
    """Format the values of an axis; the middle of a long list is omitted."""
    if len(values) <= 12:
        return ", ".join(values)
    return ", ".join([*(values[i] for i in range(3)), "...", values[len(values) - 1]]) + (
        f" ({len(values)})"
    )
