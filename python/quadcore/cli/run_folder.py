"""Output folder of ``quadcore run``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Dict, List, Mapping, Sequence, Tuple

from ..model.obstacles import draw_world
from ..model.visuals import read_vehicle
from ..report.drawing import Drawing, name_files
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import Log
from ..simulation.simulation import Simulation
from ..simulation.trajectory import find_speed_limit, per_command
from ..studies.flight_folder import DOCUMENT, WrittenFlight, write_flights

LOG = "log.csv"
MODEL = "model.urdf"
PAGE = "report.html"
FILES = (LOG, MODEL, DOCUMENT, PAGE)

_PLOTS = {
    "position": "Position of the frame",
    "attitude": "Attitude of the frame",
    "rates": "Angular rates",
    "rotors": "Rotor speeds",
    "wrenches": "Forces and torques",
    "path": "Path of the frame",
    "error": "Tracking error",
    "autopilot": "Autopilot",
}
"""Headings on the page by the name of the plot."""


def write_description(
    arguments: argparse.Namespace, plan: FlightPlan, simulation: Simulation
) -> List[Path]:
    """Write the expanded URDF, and the settings from which the flight can be repeated."""
    settings = {
        "model": plan.model.name,
        "engine": plan.engine,
        "world": arguments.world or "empty",
        "seed": plan.seed,
        "dt": plan.step,
        "duration": plan.duration,
        "parameters": dict(plan.parameters),
        "ignore": list(arguments.ignore),
        "unsimulated": simulation.world.ignored_elements.unsimulated,
    }
    flight = WrittenFlight(
        plan.model.name,
        LOG,
        plan.model,
        plan.world,
        speed_limit=find_speed_limit(simulation.rotors),
    )
    return [arguments.out / MODEL, *write_flights(arguments.out, [flight], settings, MODEL)]


def _describe_conditions(plan: FlightPlan, summary: Mapping[str, str]) -> str:
    """Describe the conditions of the flight in one line, for the head of the page."""
    parts = [f"Model {plan.model.name}", f"engine {plan.engine}"]
    parts += [f"{name} {summary[name]}" for name in ("controller", "reference") if name in summary]
    step = f"{summary['duration']} at steps of {1e3 * plan.step:g} ms"
    return "; ".join([*parts, step, f"seed {plan.seed}"]) + "."


def _draw(log: Log, folder: Path) -> Dict[str, Drawing]:
    from ..report.log_plots import draw  # matplotlib is slow to import

    return draw(log, folder)


def write_results(
    arguments: argparse.Namespace,
    plan: FlightPlan,
    simulation: Simulation,
    log: Log,
    rows: Sequence[Tuple[str, str]],
) -> List[Path]:
    """Write the plots and the page."""
    from ..report.page import write_page  # jinja2 is slow to import
    from ..report.player import PlayerFlight, make_section

    log.per_command = per_command(simulation)
    name = f"{simulation.model.name}, {simulation.engine}"
    log.title = ", ".join(filter(None, (name, log.title)))
    plots = {} if arguments.no_plots else _draw(log, arguments.out)
    page = arguments.out / PAGE
    flight = PlayerFlight(
        name,
        log,
        read_vehicle(plan.model),
        speed_limit=find_speed_limit(simulation.rotors),
    )
    write_page(
        page,
        "run.html",
        title=name,
        conditions=_describe_conditions(plan, dict(rows)),
        rows=rows,
        player=make_section([flight], draw_world(simulation.world)),
        plots=[(name, _PLOTS.get(name, name), drawing) for name, drawing in plots.items()],
    )
    files = [file for name, drawing in plots.items() for file in name_files(name, drawing)]
    return [*(arguments.out / file for file in files), page]
