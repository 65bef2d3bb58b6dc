"""The folder of one flight: what ``quadcore run`` writes there, and what other commands read."""

from __future__ import annotations

import argparse
import json
import platform
import shlex
import time
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Tuple

from .. import __version__
from .._core import InputError
from ..formats.bag import is_ros2
from ..model.description import read_model
from ..model.obstacles import draw_world
from ..model.visuals import read_vehicle
from ..report.drawn_vehicle import DrawnVehicle, DrawnWorld
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import Log
from ..simulation.simulation import Simulation
from ..simulation.trajectory import find_speed_limit, per_command
from ..studies.table import make_json, save_files
from ..support.input_files import is_file, read_text
from ..support.output_files import encode_text

LOG = "log.csv"
MODEL = "model.urdf"
DOCUMENT = "run.json"
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
}
"""Headings of the page, by the names of the plots."""


def write_description(arguments: argparse.Namespace, plan: FlightPlan) -> List[Path]:
    """Write the expanded URDF and what the flight can be repeated from."""
    content = {
        "command": "quadcore run",
        "arguments": shlex.join(arguments.words),
        "quadcore": __version__,
        "date": time.strftime("%Y-%m-%dT%H:%M:%S%z"),
        "host": platform.node(),
        "model": plan.model.name,
        "engine": plan.engine,
        "world": arguments.world or "empty",
        "ground": plan.world.ground_plane,
        "seed": plan.seed,
        "dt": plan.step,
        "duration": plan.duration,
        "parameters": dict(plan.parameters),
        "ignore": list(arguments.ignore),
        "log": LOG,
    }
    model = encode_text(plan.model.document.text)
    return save_files(arguments.out, {MODEL: model, DOCUMENT: make_json(content)})


def write_results(
    arguments: argparse.Namespace,
    plan: FlightPlan,
    simulation: Simulation,
    log: Log,
    rows: Sequence[Tuple[str, str]],
) -> List[Path]:
    """Write plots and page."""
    from ..report.page import write_page  # jinja2 is slow to import
    from ..report.player import PlayerFlight, make_section

    log.per_command = per_command(simulation)
    name = f"{simulation.model.name}, {simulation.engine}"
    log.title = ", ".join(filter(None, (name, log.title)))
    plots = [] if arguments.no_plots else log.plot(arguments.out)
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
        rows=rows,
        player=make_section([flight], draw_world(simulation.world)),
        plots=[(_PLOTS.get(file.stem, file.stem), file.read_bytes()) for file in plots],
    )
    return [*plots, page]


def find_logs(path: Path) -> List[Path]:
    """Find the logs of a folder that `run` or `compare` wrote; a file is one log."""
    if not path.is_dir() or is_ros2(path):
        return [path]
    logs = [path / LOG] if is_file(path / LOG) else sorted((path / "logs").glob("*.csv"))
    if not logs:
        raise InputError(f"{path}: holds neither {LOG} nor logs/. Name a log, or another folder.")
    return logs


def find_vehicle(log: Path, model: Optional[str]) -> Optional[DrawnVehicle]:
    """Find what the vehicle of a log looks like: in a model, or in the folder of the log.

    Raises
    ------
    InputError
        If the folder holds the flight of another vehicle than the model.
    """
    described = _read_description(log)
    if model is not None:
        vehicle = read_model(model)
        flown = described.get("model", vehicle.name)
        if flown != vehicle.name:
            raise InputError(
                f"{log}: is a flight of '{flown}', but --model {model} is '{vehicle.name}'. "
                "Leave --model out."
            )
        return read_vehicle(vehicle)
    if not described or not is_file(log.parent / MODEL):
        return None
    return read_vehicle(read_model(log.parent / MODEL, ignore=described.get("ignore", [])))


def find_world(logs: Sequence[Path]) -> DrawnWorld:
    """Return what stands around the vehicles, from the folders of the logs."""
    return DrawnWorld(any(_read_description(log).get("ground") for log in logs))


def _read_description(log: Path) -> Dict[str, Any]:
    """Read what `run` wrote about a log; nothing about logs that it did not write."""
    file = log.parent / DOCUMENT
    if not is_file(file):
        return {}
    try:
        content = json.loads(read_text(file))
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{file}: is not JSON ({error}). Remove it, or run the flight again."
        ) from None
    if not isinstance(content, dict) or content.get("log") != log.name:
        return {}
    return content
