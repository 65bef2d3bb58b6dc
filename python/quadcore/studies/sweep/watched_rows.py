"""Rows of a sweep that are simulated again for animations, because a sweep keeps no logs."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Union

import numpy as np

from ..._core import QuadcoreError
from ...model.obstacles import draw_world, join_worlds
from ...model.visuals import read_vehicle
from ...simulation.log import Log
from ...support.warning import suppress_warnings
from ..executor import run_contained
from ..flight_folder import WrittenFlight, name_log, write_flights, write_logs
from .plan import AnyPlan
from .row_spec import Flight


class WatchedRow(NamedTuple):
    """A row that was simulated again."""

    name: str
    flight: Flight
    log: Log


def watch_rows(plan: AnyPlan, columns: Mapping[str, np.ndarray], measure: str) -> List[WatchedRow]:
    """Simulate again the rows with the median and the maximum metric, and the first failed row.

    Rows that call a function and rows that cannot start are omitted.
    """
    chosen = _choose_rows(columns, measure)
    specs = [plan.make_spec(row) for row in chosen.values()]
    flights = [spec for spec in specs if isinstance(spec, Flight)]
    logs: Dict[int, Log] = {}

    def take(index: int, found: Union[Log, QuadcoreError]) -> None:
        if not isinstance(found, QuadcoreError):
            logs[index] = found

    run_contained(Flight.watch, flights, take, apart=plan.apart)
    names = [f"row {row}, {what}" for what, row in chosen.items()]
    return [WatchedRow(names[i], flights[i], logs[i]) for i in sorted(logs)]


def write_watched_rows(rows: List[WatchedRow], folder: Path) -> List[Path]:
    """Write logs, models and ``run.json``."""
    listed = [
        WrittenFlight(row.name, name_log(number), row.flight.plan.model, row.flight.plan.world)
        for number, row in enumerate(rows, start=1)
    ]
    write_logs(folder, [row.log for row in rows])
    return write_flights(folder, listed)


def make_player(rows: List[WatchedRow]) -> Any:
    """Make an animation of the rows; "" without rows."""
    from ...report.player import PlayerFlight, make_section  # jinja2 is slow to import

    if not rows:
        return ""
    with suppress_warnings():
        shown = [
            PlayerFlight(row.name, row.log, read_vehicle(row.flight.plan.model)) for row in rows
        ]
    return make_section(shown, join_worlds([draw_world(row.flight.plan.world) for row in rows]))


def _choose_rows(columns: Mapping[str, np.ndarray], measure: str) -> Dict[str, int]:
    values = columns[measure].astype(float)
    order = np.argsort(values, kind="stable")
    order = order[np.isfinite(values[order])]
    chosen: Dict[str, int] = {}
    if len(order):
        chosen[f"median {measure}"] = int(columns["row"][order[(len(order) - 1) // 2]])
    if len(order) > 1:
        chosen[f"maximum {measure}"] = int(columns["row"][order[-1]])
    failed = np.flatnonzero(columns["failure"] != "")
    if len(failed):
        chosen["failed"] = int(columns["row"][failed[0]])
    return chosen
