"""Flights for ``quadcore play`` and ``quadcore plot``, from logs and folders of studies."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, List, NamedTuple, Optional, Sequence, Tuple

from .._core import InputError
from ..formats.bag import is_ros2
from ..model.description import read_model
from ..model.obstacles import join_worlds
from ..model.visuals import read_vehicle
from ..report.drawn_vehicle import DrawnVehicle, DrawnWorld
from ..simulation.log import Log
from ..studies.flight_folder import ListedFlight, list_flights
from ..studies.option_info import OUTPUT
from ..support import parse
from ..support.input_files import is_file
from . import options
from .parser import find_group

if TYPE_CHECKING:
    from ..report.player import PlayerFlight

_LOG = "log.csv"


class PlayedFlight(NamedTuple):
    """Log to read, and its entry in ``run.json``."""

    name: str
    log: Path
    listed: Optional[ListedFlight]


def add_logs(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for logs and their names."""
    parser.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        type=Path,
        help="log of quadcore (.csv, .mat or .bag); recording of a real flight (ULog, Crazyflie "
        "micro-SD, blackbox, CSV, bag); or a folder that a command wrote with --out",
    )
    options.add_mapping(parser)
    find_group(parser, OUTPUT).add_argument(
        "--names",
        metavar="A,B",
        type=parse.names,
        help="names of the flights (default: those of the folder, or the part in which their "
        "paths differ)",
    )


def find_flights(arguments: argparse.Namespace) -> List[PlayedFlight]:
    """Find and name the flights that the arguments of `add_logs` select."""
    found = [flight for path in arguments.logs for flight in _find_in(path)]
    names = arguments.names
    if names is None:
        names = _choose_names(found, arguments.logs)
    elif len(names) != len(found):
        raise InputError(
            f"--names: {len(names)} name(s) for {len(found)} flight(s). Name each flight."
        )
    return [PlayedFlight(name, *each) for name, each in zip(names, found)]


def read_player_flight(
    played: PlayedFlight, mapping: Optional[Path], model: Optional[str]
) -> PlayerFlight:
    """Read a log and its vehicle.

    Parameters
    ----------
    played
        Flight from `find_flights`.
    mapping
        Mapping for a recording.
    model
        Model for the shapes of the vehicle. None: that of ``run.json``, if any.

    Raises
    ------
    InputError
        If a file is invalid, or the log is from a vehicle other than the model.
    """
    from ..report.player import PlayerFlight  # jinja2 is slow to import

    listed = played.listed
    log = Log.of_file(played.log, mapping)
    vehicle = _choose_vehicle(played, model)
    if listed is None:
        return PlayerFlight(played.name, log, vehicle)
    return PlayerFlight(played.name, log, vehicle, listed.events, listed.speed_limit, listed.style)


def find_world(flights: Sequence[PlayedFlight]) -> DrawnWorld:
    """Return the ground and the obstacles listed in ``run.json``."""
    return join_worlds([flight.listed.world for flight in flights if flight.listed is not None])


def _choose_vehicle(played: PlayedFlight, model: Optional[str]) -> Optional[DrawnVehicle]:
    listed = played.listed
    if model is None:
        return None if listed is None else listed.read_vehicle()
    vehicle = read_model(model)
    if listed is not None and listed.vehicle != vehicle.name:
        raise InputError(
            f"{played.log}: is a flight of '{listed.vehicle}', but --model {model} is "
            f"'{vehicle.name}'. Leave --model out."
        )
    return read_vehicle(vehicle)


def _find_in(path: Path) -> List[Tuple[Path, Optional[ListedFlight]]]:
    """Find the logs in a folder with their entries; a file is a single log."""
    if path.is_dir() and not is_ros2(path):
        listed = [flight for flight in list_flights(path) if is_file(flight.log)]
        if listed:
            return [(flight.log, flight) for flight in listed]
        logs = [path / _LOG] if is_file(path / _LOG) else sorted((path / "logs").glob("*.csv"))
        if not logs:
            raise InputError(
                f"{path}: holds neither {_LOG} nor logs/. Name a log or another folder."
            )
        return [(log, None) for log in logs]
    for folder in (path.parent, path.parent.parent):
        for flight in list_flights(folder):
            if flight.log == path:
                return [(path, flight)]
    return [(path, None)]


def _choose_names(
    found: Sequence[Tuple[Path, Optional[ListedFlight]]], given: Sequence[Path]
) -> List[str]:
    """Return the listed names if there are several per folder and all differ, else the paths."""
    names = [flight.name for _, flight in found if flight is not None]
    if len(names) == len(found) > len(given) and len(set(names)) == len(names):
        return names
    return _name_by_path([log for log, _ in found], given)


def _name_by_path(logs: Sequence[Path], given: Sequence[Path]) -> List[str]:
    """Name logs by the differing part of their paths, as in out/ode/log.csv, out/eigen/log.csv."""
    if len(logs) == 1:
        return [given[0].resolve().name if given[0] != logs[0] else logs[0].stem]
    parts: List[Tuple[str, ...]] = [log.with_suffix("").parts for log in logs]
    if len(set(logs)) < len(logs):
        twice = next(log for i, log in enumerate(logs) if log in logs[:i])
        raise InputError(f"{twice}: is named twice. Name each log once.")
    if len(set(parts)) < len(parts):  # such as a.csv and a.mat
        return [str(log) for log in logs]
    while len({path[-1] for path in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [path[:-1] for path in parts]
    while len({path[0] for path in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [path[1:] for path in parts]
    return ["/".join(path) for path in parts]
