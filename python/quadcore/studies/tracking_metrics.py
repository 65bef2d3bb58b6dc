"""Metrics of a flight along a reference."""

from __future__ import annotations

import math
from typing import Dict, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .._core import Rotor
from ..simulation.log import Log
from ..simulation.recording import TAIL
from ..support.rotation import compute_tilts, to_yaw

FAILURE_DISTANCE = 5.0
"""Default tracking error above which a flight has failed, m."""

EQUAL = 1e-9
"""Position errors with a smaller difference count as equal, m: it is rounding noise."""

UNITS = {
    "rms_position": "m",
    "max_position": "m",
    "final_position": "m",
    "steady_position": "m",
    "iae_position": "m s",
    "itae_position": "m s^2",
    "max_yaw": "rad",
    "rise_time": "s",
    "overshoot": "",
    "settling_time": "s",
    "effort": "rad/s^2",
    "command_effort": "rad/s^2",
    "saturated": "",
    "energy": "J",
    "max_tilt": "rad",
    "max_speed": "m/s",
    "max_rate": "rad/s",
    "clearance": "m",
    "collisions": "",
}
"""Unit of each metric by name."""

MEANINGS = {
    "rms_position": "RMS tracking error",
    "max_position": "maximum tracking error",
    "final_position": f"maximum tracking error in the last {TAIL:g} s",
    "steady_position": f"norm of the mean error in the last {TAIL:g} s, at most in the second half",
    "iae_position": "integral of the tracking error",
    "itae_position": "integral of time x tracking error",
    "max_yaw": "maximum yaw error",
    "rise_time": "time from 10 % to 90 % of a step",
    "overshoot": "overshoot, relative to the step",
    "settling_time": "time until the error stays below 2 % of the step",
    "effort": "mean rate of change of the rotor speeds, over all steps",
    "command_effort": "mean rate of change of the commanded rotor speeds, over all steps",
    "saturated": "share of the controller updates that exceed a rotor limit",
    "energy": "energy of the aerodynamic torque on the rotors",
    "max_tilt": "maximum angle between the z axes of frame and world",
    "max_speed": "maximum speed of the frame's origin",
    "max_rate": "maximum norm of the angular velocity",
    "clearance": "minimum distance from an obstacle of the world",
    "collisions": "number of collisions with obstacles of the world",
}

_SETTLED = 0.02  # relative to the step
_JUMP = 1e-3  # m; a larger sudden change of the reference counts as a step


class RotorData(NamedTuple):
    """Properties of a `Rotor` that metrics need; unlike the rotor, they can be pickled."""

    torque_coefficient: float
    slowdown: float

    @classmethod
    def of(cls, rotor: Rotor) -> RotorData:
        """Return the properties of a rotor."""
        return cls(rotor.torque_coefficient, rotor.slowdown)


def find_failure_time(log: Log, distance: float = FAILURE_DISTANCE) -> Optional[float]:
    """Return the first time at which the tracking error exceeds `distance` (m), s; else None."""
    away = np.flatnonzero(~(compute_errors(log) <= distance))
    return float(log.time[away[0]]) if len(away) else None


def describe_failure(log: Log, distance: float = FAILURE_DISTANCE) -> str:
    """Describe when and where the tracking error exceeds `distance` (m); "" if it never does."""
    time = find_failure_time(log, distance)
    if time is None:
        return ""
    x, y, z = log.position[np.flatnonzero(log.time == time)[0]]
    return f"lost at t = {time:.6g} s, x = {x:.4g} m, y = {y:.4g} m, z = {z:.4g} m"


def compute_errors(log: Log) -> np.ndarray:
    """Return the tracking error, m, shape (rows,)."""
    error = log.topics["error"]
    return _compute_length(error["x"], error["y"], error["z"])


def compute_rms_and_max(away: np.ndarray) -> Tuple[float, float]:
    """Return the RMS and the maximum of tracking errors."""
    return float(np.sqrt(np.mean(away**2))), float(away.max())


def measure(
    log: Log,
    saturated: float,
    rotors: Sequence[Union[Rotor, RotorData]],
    variation: Optional[Tuple[np.ndarray, np.ndarray]] = None,
) -> Dict[str, float]:
    """Compute the metrics of a flight.

    Parameters
    ----------
    log
        Evenly spaced log with a reference.
    saturated
        Share of saturated controller updates.
    rotors
        Rotors of the vehicle.
    variation
        `ControllerPilot.variation` of the flight. By default, the rotor variation is computed from
        the rows of the log, which miss changes between them, and that of the commands is unknown.

    Returns
    -------
    dict
        Metrics in `UNITS` up to the angular velocity; NaN if undefined, such as the overshoot
        without a step.
    """
    time, away = log.time - log.time[0], compute_errors(log)
    tail = time > time[-1] - TAIL
    late = time > time[-1] - min(TAIL, time[-1] / 2)
    errors = np.column_stack([log.topics["error"][axis] for axis in "xyz"])
    yaw = to_yaw(log.orientation) - log.topics["reference"]["yaw"]
    speeds = np.abs(log.rotor_velocity) * [rotor.slowdown for rotor in rotors]
    span = max(time[-1], np.finfo(float).tiny)
    rise, overshoot, settling = _measure_step(log, away)
    rms, largest = compute_rms_and_max(away)
    if variation is None:
        variation = np.abs(np.diff(np.abs(log.rotor_velocity), axis=0)).sum(axis=0), np.empty(0)
    travelled = variation[0] * [rotor.slowdown for rotor in rotors]
    return {
        "rms_position": rms,
        "max_position": largest,
        "final_position": float(away[tail].max()),
        "steady_position": float(np.linalg.norm(errors[late].mean(axis=0))),
        "iae_position": _integrate(away, time),
        "itae_position": _integrate(away * time, time),
        "max_yaw": float(np.abs(np.remainder(yaw + np.pi, 2 * np.pi) - np.pi).max()),
        "rise_time": rise,
        "overshoot": overshoot,
        "settling_time": settling,
        "effort": float(travelled.sum() / span / max(1, len(travelled))),
        "command_effort": float(variation[1].mean() / span) if len(variation[1]) else math.nan,
        "saturated": saturated,
        "energy": _integrate(speeds**3 @ [rotor.torque_coefficient for rotor in rotors], time),
        "max_tilt": float(compute_tilts(log.orientation).max()),
        "max_speed": float(_compute_length(*log.linear_velocity.T).max()),
        "max_rate": float(_compute_length(*log.angular_velocity.T).max()),
    }


def _compute_length(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the lengths of vectors, faster than `numpy.linalg.norm` along an axis."""
    length: np.ndarray = np.sqrt(x**2 + y**2 + z**2)
    return length


def _integrate(values: np.ndarray, time: np.ndarray) -> float:
    return float(np.sum((values[1:] + values[:-1]) / 2 * np.diff(time)))


def _measure_step(log: Log, away: np.ndarray) -> Tuple[float, float, float]:
    """Return rise time, overshoot and settling time; NaN unless the reference has a single step."""
    none = math.nan, math.nan, math.nan
    wanted = np.column_stack([log.topics["reference"][axis] for axis in "xyz"])
    moved = _compute_length(*np.diff(wanted, axis=0).T)
    if len(moved) < 2:
        return none
    at = int(moved.argmax())
    if moved[at] < _JUMP or moved[at] < 10 * np.delete(moved, at).max():
        return none
    size = moved[at]
    along = (wanted[at + 1] - wanted[at]) / size
    time = log.time[at + 1 :] - log.time[at + 1]
    part = (log.position[at + 1 :] - wanted[at]) @ along / size
    begun, risen = np.flatnonzero(part >= 0.1), np.flatnonzero(part >= 0.9)
    rise = float(time[risen[0]] - time[begun[0]]) if len(risen) else math.nan
    outside = np.flatnonzero(away[at + 1 :] > _SETTLED * size)
    settles = len(outside) == 0 or outside[-1] + 1 < len(time)
    settling = (float(time[outside[-1] + 1]) if len(outside) else 0.0) if settles else math.nan
    return rise, float(max(0.0, part.max() - 1)), settling
