"""Flights of an animation, and what the page shows of them at any time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Dict, List, Optional, Sequence, Tuple

import numpy as np

from .._core import InputError
from .drawn_vehicle import DrawnVehicle
from .packing import align_signs

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation
    from ..simulation.trajectory import Trajectory

WIND = "wind"
"""Topic of the wind."""

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
        if topic.kind == "carried" or (name == WIND and topic.kind == "vector")
    ]


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
        if name == WIND and set("xyz") <= set(fields):
            columns["wind"] = (np.column_stack([fields[axis] for axis in "xyz"]), _COARSE)
        elif set(fields) - {"stamp"} == set(_PAYLOAD):
            payload = np.column_stack([fields[field] for field in _PAYLOAD])
            columns[f"payload {name}"] = (payload, 0.0)
    return columns
