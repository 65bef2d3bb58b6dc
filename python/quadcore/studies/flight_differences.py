"""Differences between two flights."""

from __future__ import annotations

from typing import Dict, NamedTuple, Sequence

import numpy as np

from ..simulation.log import Log
from ..support.rotation import subtract_angles

# Norms of difference vectors, and the angle between the attitudes.
_WHOLE = {"position": "m", "attitude": "rad", "velocity": "m/s", "rates": "rad/s"}
_PARTS = {
    **dict.fromkeys(("x", "y", "z"), "m"),
    **dict.fromkeys(("roll", "pitch", "yaw"), "rad"),
    **dict.fromkeys(("vx", "vy", "vz"), "m/s"),
    **dict.fromkeys(("wx", "wy", "wz"), "rad/s"),
}


def list_states(rotor_count: int) -> Dict[str, str]:
    """Return names and units of the columns of `compute_differences`."""
    return {**_WHOLE, **_PARTS, **{f"j{i}": "rad/s" for i in range(1, 1 + rotor_count)}}


def compute_differences(against: Log, log: Log) -> np.ndarray:
    """Compute the difference of each state from another flight, within their common time.

    If the rows have different times, the other flight is interpolated.

    Returns
    -------
    ndarray, shape (rows, 16 + n)
        Columns as in `list_states` for the n rotors of the other flight; the rotor columns are NaN
        if the numbers of rotors differ. Angles lie within [-pi, pi]; of the two equivalent
        Euler-angle triples, the nearer one is used.
    """
    log = Log(log.table[log.time <= against.time[-1] + 1e-9], {})
    against = _interpolate(log.time, against)
    position = log.position - against.position
    angles = subtract_angles(log.rpy, against.rpy)
    # |q - p| and |q + p| are 2 sin and 2 cos of a quarter of the angle. This form is exact for
    # small angles and independent of the sign of a quaternion.
    apart = np.linalg.norm(log.orientation - against.orientation, axis=1)
    together = np.linalg.norm(log.orientation + against.orientation, axis=1)
    attitude = 4 * np.arctan2(np.minimum(apart, together), np.maximum(apart, together))
    velocity = log.linear_velocity - against.linear_velocity
    rates = log.angular_velocity - against.angular_velocity
    if log.rotor_velocity.shape == against.rotor_velocity.shape:
        rotors = log.rotor_velocity - against.rotor_velocity
    else:
        rotors = np.full_like(against.rotor_velocity, np.nan)
    lengths = [np.linalg.norm(vector, axis=1) for vector in (position, velocity, rates)]
    whole = np.stack([lengths[0], attitude, *lengths[1:]], axis=1)
    return np.hstack([whole, position, angles, velocity, rates, rotors])


class DifferenceSizes(NamedTuple):
    """Final, maximum and RMS difference between two flights by state."""

    final: Dict[str, float]
    """Signed final difference."""
    max: Dict[str, float]
    """Maximum magnitude."""
    rms: Dict[str, float]


def summarise_differences(rows: np.ndarray, names: Sequence[str]) -> DifferenceSizes:
    """Compute final, maximum and RMS differences; `rows` has shape (rows, states)."""
    magnitudes = np.abs(rows)
    found = (rows[-1], magnitudes.max(axis=0), np.sqrt((magnitudes**2).mean(axis=0)))
    return DifferenceSizes(*(dict(zip(names, values.tolist())) for values in found))


def compute_final_and_max(against: Log, log: Log) -> np.ndarray:
    """Compute the final and the maximum difference of each state, shape (2, 16 + n)."""
    names = list_states(against.rotor_velocity.shape[1])
    found = summarise_differences(compute_differences(against, log), list(names))
    return np.array([list(found.final.values()), list(found.max.values())])


def _interpolate(time: np.ndarray, log: Log) -> Log:
    if np.array_equal(time, log.time[: len(time)]):
        return Log(log.table[: len(time)], {})
    table = np.stack([np.interp(time, log.time, column) for column in log.table.T], axis=1)
    table[:, 4:8] /= np.linalg.norm(table[:, 4:8], axis=1, keepdims=True)
    return Log(table, {})
