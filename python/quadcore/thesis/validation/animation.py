"""Flights of a study in an animation on the page, and as logs with their model."""

from __future__ import annotations

from pathlib import Path
from typing import Any, List, Tuple

from ...model.obstacles import draw_world
from ...model.visuals import read_vehicle
from ...simulation.log import Log
from ...studies.flight_folder import (
    WrittenFlight,
    name_log,
    remove_flights,
    write_flights,
    write_logs,
)
from .experiment import MODEL, Case
from .study import Study


def write_drawn_flights(study: Study, folder: Path) -> List[Path]:
    """Write the logs of the flights in `make_player`, their model and ``run.json``."""
    remove_flights(folder)
    flights = _choose_flights(study)
    plan = study.experiment.plan
    write_logs(folder, [log for _, log in flights])
    listed = [
        WrittenFlight(name, name_log(number), plan.model, plan.world)
        for number, (name, _) in enumerate(flights, start=1)
    ]
    return write_flights(folder, listed)


def make_player(study: Study) -> Any:
    """Make an animation of the model and the engines; "" if all flights failed."""
    from ...report.player import PlayerFlight, make_section  # jinja2 is slow to import

    plan = study.experiment.plan
    vehicle = read_vehicle(plan.model)
    shown = [PlayerFlight(name, log, vehicle) for name, log in _choose_flights(study)]
    return make_section(shown, draw_world(plan.world)) if shown else ""


def _choose_flights(study: Study) -> List[Tuple[str, Log]]:
    """Return the successful flights with the last drag, and their names."""
    drag = study.drags[-1]
    cases = {"mathematical model": Case(MODEL, 1.0, drag)}
    for engine in study.engines:
        for slow in study.sim_slow:
            cases[f"{engine}, sim_slow {slow:g}"] = Case(engine, slow, drag)
    logs = {name: study.flights[case].log for name, case in cases.items()}
    return [(name, log) for name, log in logs.items() if log is not None]
