"""Animations of flights: a page that plays logs, and the section that other pages include."""

from __future__ import annotations

import math
import pickle
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from .._core import InputError
from ..support.rotation import unwrap_angles
from .cameras import CAMERAS
from .colours import PALETTE, choose_colour, choose_dashes
from .drawn_vehicle import DrawnShape, DrawnVehicle, DrawnWorld, make_generic_vehicle
from .packing import (
    Numbers,
    align_signs,
    choose_quantum,
    choose_rows,
    make_plot_times,
    pick_extremes,
)
from .page import has_player, render

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation
    from ..simulation.trajectory import Trajectory

_WIND = "wind"
_PAYLOAD = ("mass", "x", "y", "z")  # kg, m; mass 0: no payload
_FINE = 2.0**-16  # m, and parts of a unit quaternion: the rounding of poses
_COARSE = 2.0**-6  # rad/s, m/s: the rounding of speeds


@dataclass(frozen=True, eq=False)
class PlayerFlight:
    """A flight in an animation.

    Attributes
    ----------
    name : str
        Name on the page.
    log : Trajectory
        Log of at least one row. The page shows the topic ``reference`` if it has fields x, y, z,
        and the topics that `list_animated_topics` returns.
    vehicle : DrawnVehicle, optional
        Shapes to draw, from `read_vehicle`. Without them, the vehicle is a star of arms.
    events : sequence of (float, str)
        Times (s) and descriptions of events, marked in the plots.
    speed_limit : float
        Maximum rotor joint speed, rad/s; infinite without one.
    style : int, optional
        Number of the colour and line style, as for `curve_style`; default: the place among the
        flights.
    """

    name: str
    log: Trajectory
    vehicle: Optional[DrawnVehicle] = None
    events: Sequence[Tuple[float, str]] = ()
    speed_limit: float = math.inf
    style: Optional[int] = None

    def __post_init__(self) -> None:
        """Check that log and vehicle can be drawn."""
        if len(self.log) == 0:
            raise InputError(f"flight '{self.name}': the log is empty. Give a log with rows.")
        turning = self.log.rotor_velocity.shape[1]
        if self.vehicle is not None and self.vehicle.rotor_count != turning:
            raise InputError(
                f"flight '{self.name}': the log has {turning} rotors, but the vehicle "
                f"'{self.vehicle.name}' has {self.vehicle.rotor_count}. Name the model of the log."
            )


def list_animated_topics(simulation: Simulation) -> List[str]:
    """List the topics that an animation shows with the flight: wind and payloads."""
    published = {n: topic for n, topic in simulation.topics.items() if topic.writer is not None}
    return [
        name
        for name, topic in published.items()
        if topic.kind == "carried" or (name == _WIND and topic.kind == "vector")
    ]


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
        "plots": _pack_plots(flights, numbers),
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
    packed["speed_limit"] = _or_none(speed_limit)
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


def list_columns(log: Trajectory) -> Dict[str, Tuple[np.ndarray, float]]:
    """List what the page shows at any time, and the rounding of each: at least the pose."""
    columns = {
        "time": (log.time[:, None], 0.0),
        "position": (log.position, _FINE),
        "orientation": (align_signs(log.orientation), _FINE),
        "rotor_velocity": (log.rotor_velocity, _COARSE),
    }
    reference = log.topics.get("reference", {})
    if set("xyz") <= set(reference):  # a plugin's topic may have the same name
        axes = [*"xyz", *(["yaw"] if "yaw" in reference else [])]
        columns["reference"] = (np.column_stack([reference[axis] for axis in axes]), _FINE)
    for name, fields in log.topics.items():
        if name == _WIND and set("xyz") <= set(fields):
            columns["wind"] = (np.column_stack([fields[axis] for axis in "xyz"]), _COARSE)
        elif set(fields) - {"stamp"} == set(_PAYLOAD):
            payload = np.column_stack([fields[field] for field in _PAYLOAD])
            columns[f"payload {name}"] = (payload, 0.0)
    return columns


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
        "speed_limit": _or_none(flight.speed_limit),
        "columns": {
            name: {"width": values.shape[1], "values": numbers.add(values[rows], quantum)}
            for name, (values, quantum) in columns.items()
        },
    }


def _or_none(limit: float) -> Optional[float]:
    """Return a limit, or None for an infinite one, which JSON does not have."""
    return limit if math.isfinite(limit) else None


def _pack_plots(flights: Sequence[PlayerFlight], numbers: Numbers) -> List[Dict[str, Any]]:
    """Describe the plots under the animation."""
    begin = min(float(flight.log.time[0]) for flight in flights)
    end = max(float(flight.log.time[-1]) for flight in flights)
    time = numbers.add(make_plot_times(begin, end))
    panels: Dict[str, Dict[str, Any]] = {}
    for number, flight in enumerate(flights):
        for title, part, values in _list_curves(flight.log):
            panel = panels.setdefault(
                title,
                {"name": title, "time": time, "least": _PANELS[title], "curves": [], "limits": []},
            )
            reduced = pick_extremes(flight.log.time, values, begin, end)
            packed = numbers.add(reduced, choose_quantum(reduced))
            panel["curves"].append({"flight": number, "part": part, "values": packed})
            limit = _or_none(flight.speed_limit)
            if title == _ROTORS and limit is not None and limit not in panel["limits"]:
                panel["limits"].append(limit)
    order = {name: i for i, name in enumerate(_PANELS)}
    return sorted(panels.values(), key=lambda panel: order[panel["name"]])


_ROTORS = "Rotor speed (rad/s)"
_PANELS = {
    "Tracking error (m)": 1e-7,
    "Height (m)": 1e-3,
    "Attitude (deg)": 1e-3,
    _ROTORS: 1e-2,
    "Wind speed (m/s)": 1e-2,
}
"""Plots in their order, and the range below which a curve is a flat line."""


def _list_curves(log: Trajectory) -> List[Tuple[str, str, np.ndarray]]:
    """List panel, part of the vehicle ("": the whole) and values of each curve."""
    curves: List[Tuple[str, str, np.ndarray]] = [("Height (m)", "", log.position[:, 2])]
    with np.errstate(all="ignore"):
        reference = log.topics.get("reference", {})
        if set("xyz") <= set(reference):
            away = log.position - np.column_stack([reference[axis] for axis in "xyz"])
            curves.append(("Tracking error (m)", "", np.linalg.norm(away, axis=1)))
        angles = np.degrees(unwrap_angles(log.rpy))
        curves += [
            ("Attitude (deg)", name, angle)
            for name, angle in zip(("roll", "pitch", "yaw"), angles.T)
        ]
        speeds = np.abs(log.rotor_velocity)
        curves += [(_ROTORS, f"rotor {i}", speed) for i, speed in enumerate(speeds.T, start=1)]
        wind = log.topics.get(_WIND, {})
        if set("xyz") <= set(wind):
            vector = np.column_stack([wind[axis] for axis in "xyz"])
            curves.append(("Wind speed (m/s)", "", np.linalg.norm(vector, axis=1)))
    return curves
