"""Animations of flights: a page that plays logs, and the section that other pages include."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence

import numpy as np

from .._core import InputError
from .colours import DASHES, PALETTE
from .decimation import pick_evenly
from .page import render

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation
    from ..simulation.trajectory import Trajectory

_POINTS = 1500  # per flight: 50 per second in half a minute; the page interpolates
_WIND = "wind"
_PAYLOAD = (
    "mass",
    "x",
    "y",
    "z",
)  # kg, m; mass 0: no payload
_ARM = 0.25  # m, length of the arms of an unknown vehicle


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
    rotors : ndarray (n, 3), optional
        Positions of the rotors in the frame, m, as in `Model.joint_places`. Without them the
        vehicle is drawn as a cross.
    """

    name: str
    log: Trajectory
    rotors: Optional[np.ndarray] = None

    def __post_init__(self) -> None:
        """Check that log and rotors can be drawn."""
        if len(self.log) == 0:
            raise InputError(f"flight '{self.name}': the log is empty. Give a log with rows.")
        turning = self.log.rotor_velocity.shape[1]
        if self.rotors is not None and np.shape(self.rotors) != (turning, 3):
            raise InputError(
                f"flight '{self.name}': rotors has shape {np.shape(self.rotors)}, but the log has "
                f"{turning} rotors. Give an array of shape ({turning}, 3)."
            )


def list_animated_topics(simulation: Simulation) -> List[str]:
    """List the topics that an animation shows with the flight: wind and payloads."""
    published = {n: topic for n, topic in simulation.topics.items() if topic.writer is not None}
    return [
        name
        for name, topic in published.items()
        if topic.kind == "carried" or (name == _WIND and topic.kind == "vector")
    ]


def make_page(flights: Sequence[PlayerFlight], title: str = "Flights") -> str:
    """Make a page that animates flights.

    Parameters
    ----------
    flights
        At least one. Each appears at the time of its first row.
    title
        Heading of the page.

    Returns
    -------
    str
        HTML that needs no other file and no network. Equal flights give equal text.

    Raises
    ------
    InputError
        If there is no flight.
    """
    return render("play.html", title=title, player=make_section(flights))


def make_section(flights: Sequence[PlayerFlight]) -> str:
    """Make an animation for another page; see `make_page`.

    Returns
    -------
    markupsafe.Markup
        Section with its own style, data and script; a page may contain several.
    """
    from markupsafe import Markup

    if not flights:
        raise InputError("no flight to animate. Give at least one.")
    content: Dict[str, Any] = {
        "colours": PALETTE,
        "dashes": [[] if dashes == "-" else dashes[1] for dashes in DASHES],
        "flights": [_pack_flight(flight) for flight in flights],
    }
    return Markup(render("player.html", content=content))


def _pack_flight(flight: PlayerFlight) -> Dict[str, Any]:
    log = flight.log
    rows = pick_evenly(len(log), _POINTS)
    reference = log.topics.get("reference", {})
    columns = {
        "time": log.time,
        "position": log.position,
        "orientation": log.orientation,
        "rotor_velocity": log.rotor_velocity,
    }
    if set("xyz") <= set(reference):  # a plugin's topic may have the same name
        columns["reference"] = np.column_stack([reference[axis] for axis in "xyz"])
    for name, fields in log.topics.items():
        if name == _WIND and set("xyz") <= set(fields):
            columns["wind"] = np.column_stack([fields[axis] for axis in "xyz"])
        elif set(fields) - {"stamp"} == set(_PAYLOAD):
            columns[f"carried {name}"] = np.column_stack([fields[field] for field in _PAYLOAD])
    return {
        "name": flight.name,
        "rotors": _rotor_positions(flight),
        "columns": {name: _pack(values[rows]) for name, values in columns.items()},
    }


def _rotor_positions(flight: PlayerFlight) -> List[List[float]]:
    if flight.rotors is not None:
        return np.asarray(flight.rotors, dtype=float).tolist()  # type: ignore[no-any-return]
    count = flight.log.rotor_velocity.shape[1]
    angles = 2 * np.pi * (np.arange(count) + 0.5) / count
    cross = _ARM * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    return cross.round(6).tolist()  # type: ignore[no-any-return]


def _pack(values: np.ndarray) -> str:
    """Encode as single precision, row by row, little-endian, in base 64."""
    with np.errstate(over="ignore"):  # a vehicle may be very far away
        single = np.ascontiguousarray(values, dtype="<f4")
    return base64.b64encode(single.tobytes()).decode()
