"""Flights in an output folder: logs, expanded models, and ``run.json``, which lists the flights."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .._core import InputError, Model, World
from ..model.description import read_model
from ..model.obstacles import draw_world
from ..model.visuals import read_vehicle
from ..report.drawn_vehicle import DrawnShape, DrawnVehicle, DrawnWorld
from ..report.run_record import describe_command
from ..simulation.log import Log
from ..support.input_files import is_file, read_text
from ..support.output_files import encode_text, make_folder
from .output_folder import remove_listed_files
from .table import make_json, save_files

DOCUMENT = "run.json"
_LARGEST = 10**8  # maximum size of run.json, bytes


class WrittenFlight(NamedTuple):
    """A flight in an output folder.

    Attributes
    ----------
    name : str
        Name on pages.
    log : str
        Path of the log, relative to the folder.
    model, world : Model, World
        Vehicle and world that were simulated.
    events : sequence of (float, str)
        Times (s) and descriptions of events.
    speed_limit : float
        Maximum speed of the rotor joints, rad/s; infinite without a limit.
    style : int, optional
        Index of the colour, as for `PlayerFlight`.
    """

    name: str
    log: str
    model: Model
    world: World
    events: Sequence[Tuple[float, str]] = ()
    speed_limit: float = math.inf
    style: Optional[int] = None


class ListedFlight(NamedTuple):
    """A flight listed in ``run.json``; attributes as for `WrittenFlight`."""

    name: str
    log: Path
    vehicle: str
    model: Path
    ignore: Sequence[str]
    world: DrawnWorld
    events: Sequence[Tuple[float, str]]
    speed_limit: float
    style: Optional[int]

    def read_vehicle(self) -> Optional[DrawnVehicle]:
        """Read the shapes of the vehicle; return None if the model file does not exist."""
        if not is_file(self.model):
            return None
        return read_vehicle(read_model(self.model, ignore=self.ignore))


def name_log(number: int) -> str:
    """Return the relative path of a flight's log; numbers start at 1."""
    return f"logs/{number}.csv"


def write_logs(folder: Path, logs: Sequence[Log]) -> None:
    """Write logs to the paths of `name_log`."""
    if logs:
        make_folder(folder / "logs")
    for number, log in enumerate(logs, start=1):
        log.to_csv(folder / name_log(number))


def write_flights(
    folder: Path,
    flights: Sequence[WrittenFlight],
    settings: Optional[Mapping[str, Any]] = None,
    model_file: str = "",
) -> List[Path]:
    """Write ``run.json``, and each model once; the caller writes the logs.

    Parameters
    ----------
    folder
        Existing folder.
    flights
        Flights to list.
    settings
        Additional entries of ``run.json``.
    model_file
        Path of the model file (default: ``models/N.urdf``).

    Returns
    -------
    list of Path
        Path of ``run.json``.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    models: Dict[str, str] = {}
    worlds: List[Any] = []
    listed = []
    for flight in flights:
        number = 1 + len(models)
        file = models.setdefault(flight.model.document.text, model_file or f"models/{number}.urdf")
        world = _describe_world(draw_world(flight.world))
        if world not in worlds:
            worlds.append(world)
        listed.append(
            {
                "name": flight.name,
                "log": flight.log,
                "vehicle": flight.model.name,
                "model": file,
                "ignore": list(flight.model.ignored_elements.ignored),
                "world": worlds.index(world),
                "events": [list(event) for event in flight.events],
                "speed_limit": flight.speed_limit if math.isfinite(flight.speed_limit) else None,
                "style": flight.style,
            }
        )
    if models and not model_file:
        make_folder(folder / "models")
    content = {
        **describe_command(),
        **(settings or {}),
        "worlds": worlds,
        "flights": listed,
        "files": [*dict.fromkeys(each["log"] for each in listed), *models.values()],
    }
    save_files(folder, {file: encode_text(text) for text, file in models.items()})
    return save_files(folder, {DOCUMENT: make_json(content)})


def remove_flights(folder: Path) -> None:
    """Remove the logs and models listed in the ``run.json`` of an earlier study."""
    is_ours = re.compile(r"(logs|models)/[0-9]+\.(csv|urdf)").fullmatch
    remove_listed_files(folder, DOCUMENT, "files", is_ours)


def list_flights(folder: Path) -> List[ListedFlight]:
    """List the flights of a folder; empty without ``run.json``.

    Raises
    ------
    InputError
        If ``run.json`` is damaged.
    """
    file = folder / DOCUMENT
    if not is_file(file):
        return []
    try:
        content = json.loads(read_text(file, _LARGEST))
        worlds = [_make_world(world) for world in content["worlds"]]
        return [
            ListedFlight(
                str(each["name"]),
                folder / each["log"],
                str(each["vehicle"]),
                folder / each["model"],
                list(map(str, each["ignore"])),
                worlds[each["world"]],
                [(float(time), str(text)) for time, text in each["events"]],
                math.inf if each["speed_limit"] is None else float(each["speed_limit"]),
                None if each["style"] is None else int(each["style"]),
            )
            for each in content["flights"]
        ]
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{file}: is not JSON ({error}). Remove it, or run the flight again."
        ) from None
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise InputError(
            f"{file}: does not list flights ({error}). Remove it, or run the flight again."
        ) from None


def _describe_world(world: DrawnWorld) -> Dict[str, Any]:
    obstacles = [
        {"kind": shape.kind, "size": list(shape.size), "pose": shape.pose.tolist()}
        for shape in world.obstacles
    ]
    return {"ground": world.ground, "obstacles": obstacles}


def _make_world(described: Mapping[str, Any]) -> DrawnWorld:
    shapes = [
        DrawnShape(str(each["kind"]), tuple(each["size"]), np.array(each["pose"], float))
        for each in described["obstacles"]
    ]
    return DrawnWorld(bool(described["ground"]), shapes)
