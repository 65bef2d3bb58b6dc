"""Observations by name."""

from __future__ import annotations

from typing import Callable, Dict, NamedTuple

import numpy as np

from .step_data import StepData


class Observation(NamedTuple):
    """Observation: a row of numbers for each vehicle."""

    meaning: str
    """Description with axes and units."""
    compute: Callable[[StepData], np.ndarray]
    """Returns the observations, shape (n, width)."""
    bound: float = float(np.finfo(np.float32).max)
    """Maximum magnitude; finite, because Gymnasium requires it."""


OBSERVATIONS: Dict[str, Observation] = {
    "error": Observation("vector from the goal to the vehicle, world axes, m", lambda s: s.error),
    "body_error": Observation(
        "vector from the goal to the vehicle, body axes, m",
        lambda s: np.einsum("nji,nj->ni", s.R_WF, s.error),
    ),
    "rotation": Observation(
        "rotation matrix from body to world axes, row by row",
        lambda s: s.R_WF.reshape(len(s.R_WF), 9),
        1.0,
    ),
    "up": Observation("the world's z axis, body axes", lambda s: s.R_WF[:, 2], 1.0),
    "velocity": Observation(
        "velocity of the frame's origin, world axes, m/s", lambda s: s.linear_velocity
    ),
    "body_velocity": Observation(
        "velocity of the frame's origin, body axes, m/s",
        lambda s: np.einsum("nji,nj->ni", s.R_WF, s.linear_velocity),
    ),
    "rates": Observation("angular velocity, body axes, rad/s", lambda s: s.angular_velocity),
    "rotors": Observation("joint velocities of the engine, rad/s", lambda s: s.rotor_velocity),
    "action": Observation("the last action", lambda s: s.action, 1.0),
}
