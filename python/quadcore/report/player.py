"""Animations of flights: a page that plays logs, and the section that other pages include."""

from __future__ import annotations

import math
import pickle
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence

import numpy as np

from .._core import InputError
from .cameras import CAMERAS
from .colours import PALETTE, choose_colour, choose_dashes
from .drawn_vehicle import DrawnShape, DrawnVehicle, DrawnWorld, make_generic_vehicle
from .packing import Numbers, choose_rows, finite_or_none
from .page import has_player, render
from .player_flight import PlayerFlight as PlayerFlight
from .player_flight import list_columns
from .player_plots import pack_plots

if TYPE_CHECKING:
    from ..simulation.trajectory import Trajectory


def make_page(
    flights: Sequence[PlayerFlight],
    title: str = "Flights",
    world: Optional[DrawnWorld] = None,
    camera: str = CAMERAS[0],
) -> str:
    """Make a page that animates flights.

    Parameters
    ----------
    flights
        At least one. Each appears at the time of its first row.
    title
        Heading of the page.
    world
        Ground and obstacles; default: neither.
    camera
        One of `CAMERAS`.

    Returns
    -------
    str
        HTML that needs no other file and no network. Equal flights give equal text.

    Raises
    ------
    InputError
        If there is no flight, or no such camera.
    """
    return render("play.html", title=title, player=make_section(flights, world, camera))


def make_section(
    flights: Sequence[PlayerFlight],
    world: Optional[DrawnWorld] = None,
    camera: str = CAMERAS[0],
) -> str:
    """Make an animation for another page; see `make_page`.

    Returns
    -------
    markupsafe.Markup
        Section with its own data; a page may contain several. `render` adds the script.
    """
    if not flights:
        raise InputError("no flight to animate. Give at least one.")
    numbers = Numbers()
    vehicles = _number_vehicles(flights)
    content = {
        **_describe_world(world, camera, numbers),
        "vehicles": _pack_vehicles(flights, numbers),
        "flights": [
            {**_pack_flight(flight, i, numbers), "vehicle": vehicles[i]}
            for i, flight in enumerate(flights)
        ],
        "plots": pack_plots(flights, numbers),
    }
    return render_section(content, numbers)


def make_live_page(
    title: str,
    log: Trajectory,
    vehicle: DrawnVehicle,
    world: DrawnWorld,
    url: str,
    speed_limit: float = math.inf,
    camera: str = CAMERAS[0],
) -> str:
    """Make a page that shows a flight while it goes on.

    Parameters
    ----------
    title
        Heading of the page, and name of the flight.
    log
        Log without rows; its columns are those that `url` will send.
    vehicle, world
        Shapes to draw.
    url
        Address of the rows, as server-sent events with the columns of `list_columns`.
    speed_limit
        Maximum rotor joint speed, rad/s.
    camera
        As for `make_page`.
    """
    numbers = Numbers()
    packed: Dict[str, Any] = {
        "name": title,
        "vehicle": 0,
        "colour": choose_colour(0),
        "dash": [],
        "events": [],
    }
    packed["columns"] = {
        name: {"width": values.shape[1], "values": numbers.add([])}
        for name, (values, _) in list_columns(log).items()
    }
    packed["order"] = list(packed["columns"])  # of the columns in each row
    packed["speed_limit"] = finite_or_none(speed_limit)
    content = {
        **_describe_world(world, camera, numbers),
        "vehicles": [pack_vehicle(vehicle, numbers)],
        "flights": [packed],
        "plots": [],
        "live": url,
    }
    return render("play.html", title=title, player=render_section(content, numbers))


def render_section(content: Dict[str, Any], numbers: Numbers) -> str:
    """Make the section of a page from what the script reads."""
    from markupsafe import Markup

    if not has_player():
        return Markup(render("no_player.html"))
    return Markup(render("player.html", content=content, numbers=numbers.pack(), cameras=CAMERAS))


def _number_vehicles(flights: Sequence[PlayerFlight]) -> List[int]:
    """Return the number of each flight's vehicle; equal vehicles have the same number."""
    seen: Dict[Any, int] = {}
    return [seen.setdefault(_identify(flight), len(seen)) for flight in flights]


def _identify(flight: PlayerFlight) -> Any:
    if flight.vehicle is not None:
        return pickle.dumps(flight.vehicle)
    return ("generic", flight.log.rotor_velocity.shape[1])


def _describe_world(world: Optional[DrawnWorld], camera: str, numbers: Numbers) -> Dict[str, Any]:
    if camera not in CAMERAS:
        raise InputError(f"camera '{camera}' is unknown. Use one of {', '.join(CAMERAS)}.")
    shown = world or DrawnWorld()
    return {
        "camera": camera,
        "palette": PALETTE,
        "ground": shown.ground,
        "obstacles": [_pack_shape(obstacle, numbers) for obstacle in shown.obstacles],
    }


def _pack_vehicles(flights: Sequence[PlayerFlight], numbers: Numbers) -> List[Dict[str, Any]]:
    drawn: Dict[Any, DrawnVehicle] = {}
    for flight in flights:
        rotors = flight.log.rotor_velocity.shape[1]
        drawn.setdefault(_identify(flight), flight.vehicle or make_generic_vehicle(rotors))
    return [pack_vehicle(vehicle, numbers) for vehicle in drawn.values()]


def pack_vehicle(vehicle: DrawnVehicle, numbers: Numbers) -> Dict[str, Any]:
    """Describe a vehicle for the script."""
    return {
        "bodies": [
            {
                "pose": _round(body.pose),
                "axis": _round(body.axis),
                "shapes": [_pack_shape(shape, numbers) for shape in body.shapes],
            }
            for body in vehicle.bodies
        ]
    }


def _pack_shape(shape: DrawnShape, numbers: Numbers) -> Dict[str, Any]:
    packed: Dict[str, Any] = {
        "kind": shape.kind,
        "size": list(shape.size),
        "pose": _round(shape.pose),
        "colour": list(shape.colour),
    }
    if shape.vertices is not None and shape.faces is not None:
        packed.update(vertices=numbers.add(shape.vertices), faces=numbers.add(shape.faces))
    return packed


def _round(matrix: np.ndarray) -> List[float]:
    """Return the entries of a matrix, row by row, without rounding noise of their computation."""
    return (np.asarray(matrix, float).ravel().round(9) + 0.0).tolist()  # type: ignore[no-any-return]


def _pack_flight(flight: PlayerFlight, number: int, numbers: Numbers) -> Dict[str, Any]:
    log = flight.log
    columns = list_columns(log)
    payloads = [values for name, (values, _) in columns.items() if name.startswith("payload ")]
    changes = [np.flatnonzero(np.diff(values[:, 0])) for values in payloads]
    marks = [row for found in changes if len(found) < 100 for row in (*found, *(found + 1))]
    rows = choose_rows(log.time, log.position, log.orientation, marks)
    style = number if flight.style is None else flight.style
    return {
        "name": flight.name,
        "colour": choose_colour(style),
        "dash": choose_dashes(style),
        "events": [{"time": float(time), "text": text} for time, text in flight.events],
        "speed_limit": finite_or_none(flight.speed_limit),
        "columns": {
            name: {"width": values.shape[1], "values": numbers.add(values[rows], quantum)}
            for name, (values, quantum) in columns.items()
        },
    }
