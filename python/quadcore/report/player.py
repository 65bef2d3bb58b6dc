"""Flights to watch: a page that plays logs, and the part of it that other pages include."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence

import numpy as np

from .._core import InputError
from .colours import PALETTE
from .page import render
from .thinning import pick_evenly

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation
    from ..simulation.trajectory import Trajectory

_POINTS = 1500  # per flight: 50 in a second of half a minute, between which the page interpolates
_COLOURS = PALETTE[:6]  # legible on light and on dark
_WIND = "wind"
_CARRIED = ("mass", "x", "y", "z")  # of a body that rides on the frame, kg and m; no mass: none
_REACH = 0.25  # m, of a vehicle of which no more is known


@dataclass(frozen=True, eq=False)
class PlayerFlight:
    """A flight to watch.

    Attributes
    ----------
    name : str
        What it is called on the page.
    log : Trajectory
        At least one row. If it has a topic ``reference`` with fields x, y, z, that is drawn, and
        what `topics_to_watch` names.
    rotors : ndarray (n, 3), optional
        Places of the rotors in the frame, m, as `Model.joint_places` gives them. Without, the
        vehicle is drawn as a cross.
    """

    name: str
    log: Trajectory
    rotors: Optional[np.ndarray] = None

    def __post_init__(self) -> None:
        """Refuse what cannot be drawn."""
        if len(self.log) == 0:
            raise InputError(f"flight '{self.name}': its log is empty; there is nothing to watch")
        turning = self.log.rotor_velocity.shape[1]
        if self.rotors is not None and np.shape(self.rotors) != (turning, 3):
            raise InputError(
                f"flight '{self.name}': rotors has shape {np.shape(self.rotors)}; its log is of "
                f"{turning} rotors: give an array of shape ({turning}, 3)"
            )


def topics_to_watch(simulation: Simulation) -> List[str]:
    """Name the topics that a player draws beside the flight: the wind, and what is carried."""
    published = {n: topic for n, topic in simulation.topics.items() if topic.writer is not None}
    return [
        name
        for name, topic in published.items()
        if topic.kind == "carried" or (name == _WIND and topic.kind == "vector")
    ]


def page(flights: Sequence[PlayerFlight], title: str = "Flights") -> str:
    """Make a page that plays flights.

    Parameters
    ----------
    flights
        At least one; all start at the times of their logs.
    title
        Heading of the page.

    Returns
    -------
    str
        HTML that needs no other file and no network. The same flights give the same text.

    Raises
    ------
    InputError
        No flight.
    """
    return render("play.html", title=title, player=fragment(flights))


def fragment(flights: Sequence[PlayerFlight]) -> str:
    """Make a player to be put into another page; see `page`.

    Returns
    -------
    markupsafe.Markup
        A section with style, data and script of its own; a page may hold several.
    """
    from markupsafe import Markup

    if not flights:
        raise InputError("there is no flight to watch; give one")
    content = {"colours": _COLOURS, "flights": [_told(flight) for flight in flights]}
    return Markup(render("player.html", content=content))


def _told(flight: PlayerFlight) -> Dict[str, Any]:
    log = flight.log
    rows = pick_evenly(len(log), _POINTS)
    reference = log.topics.get("reference", {})
    told = {
        "time": log.time,
        "position": log.position,
        "orientation": log.orientation,
        "rotor_velocity": log.rotor_velocity,
    }
    if set("xyz") <= set(reference):  # a plugin may call anything so
        told["reference"] = np.column_stack([reference[axis] for axis in "xyz"])
    for name, fields in log.topics.items():
        if name == _WIND and set("xyz") <= set(fields):
            told["wind"] = np.column_stack([fields[axis] for axis in "xyz"])
        elif set(fields) - {"stamp"} == set(_CARRIED):
            told[f"carried {name}"] = np.column_stack([fields[field] for field in _CARRIED])
    return {
        "name": flight.name,
        "rotors": _places(flight),
        "columns": {name: _packed(values[rows]) for name, values in told.items()},
    }


def _places(flight: PlayerFlight) -> List[List[float]]:
    if flight.rotors is not None:
        return np.asarray(flight.rotors, dtype=float).tolist()  # type: ignore[no-any-return]
    count = flight.log.rotor_velocity.shape[1]
    angles = 2 * np.pi * (np.arange(count) + 0.5) / count
    cross = _REACH * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    return cross.round(6).tolist()  # type: ignore[no-any-return]


def _packed(values: np.ndarray) -> str:
    """Single precision, row by row, little-endian, in base 64: finer than a picture shows."""
    with np.errstate(over="ignore"):  # of what flew away
        single = np.ascontiguousarray(values, dtype="<f4")
    return base64.b64encode(single.tobytes()).decode()
