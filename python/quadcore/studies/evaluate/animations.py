"""Drawn flights of an evaluation: animations on the page, and logs with their models."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Tuple

from ...model.obstacles import draw_world, join_worlds
from ..flight_folder import WrittenFlight, name_log, write_flights, write_logs
from .evaluate import Evaluation
from .plan import Plan
from .plots import group_flights, name_group


def make_animations(evaluation: Evaluation, plan: Plan) -> List[Dict[str, Any]]:
    """Make one animation for each combination of reference and scenario."""
    from ...report.player import PlayerFlight, make_section

    animations = []
    for (reference, scenario), flights in group_flights(evaluation).items():
        marks = _list_marks(plan, scenario)
        shown = [
            PlayerFlight(label, outcome.log, outcome.vehicle, marks, outcome.limit, style)
            for label, outcome, style, _ in flights
            if outcome.log is not None
        ]
        plans = [plan.make_plan_of_row(flight.row) for flight in flights]
        world = join_worlds([draw_world(flown.world) for flown in plans])
        name = name_group(evaluation, reference, scenario)
        animations.append({"name": name, "player": make_section(shown, world)})
    return animations


def write_drawn_flights(evaluation: Evaluation, plan: Plan, folder: Path) -> List[Path]:
    """Write the logs and models of the drawn flights, and ``run.json``."""
    listed, logs = [], []
    for (reference, scenario), flights in group_flights(evaluation).items():
        marks = _list_marks(plan, scenario)
        for label, outcome, style, row in flights:
            if outcome.log is None:
                continue
            logs.append(outcome.log)
            flown = plan.make_plan_of_row(row)
            listed.append(
                WrittenFlight(
                    f"{name_group(evaluation, reference, scenario)}: {label}",
                    name_log(len(logs)),
                    flown.model,
                    flown.world,
                    marks,
                    outcome.limit,
                    style,
                )
            )
    write_logs(folder, logs)
    return write_flights(folder, listed)


def _list_marks(plan: Plan, scenario: str) -> List[Tuple[float, str]]:
    """List the times (s) and descriptions of the events of a scenario."""
    return [(event.time, event.text) for event in plan.list_events().get(scenario, ())]
