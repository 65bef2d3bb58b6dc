"""Metrics of a flight without a reference."""

from __future__ import annotations

from typing import Dict

import numpy as np

from ...simulation.log import Log
from ...support.rotation import compute_tilts, to_yaw

UNITS = {
    "final_x": "m",
    "final_y": "m",
    "final_z": "m",
    "final_yaw": "rad",
    "final_tilt": "rad",
    "final_speed": "m/s",
    "max_tilt": "rad",
    "max_speed": "m/s",
    "max_rate": "rad/s",
    "travelled": "m",
}
"""Unit of each metric by name."""

MEANINGS = {
    "final_x": "position of the frame at the end",
    "final_y": "position of the frame at the end",
    "final_z": "position of the frame at the end",
    "final_yaw": "heading at the end",
    "final_tilt": "angle between the z axes of frame and world at the end",
    "final_speed": "speed of the frame's origin at the end",
    "max_tilt": "maximum tilt",
    "max_speed": "maximum speed of the frame's origin",
    "max_rate": "maximum norm of the angular velocity",
    "travelled": "length of the path",
}


def measure(log: Log) -> Dict[str, float]:
    """Compute the metrics in `UNITS`."""
    tilt = compute_tilts(log.orientation)
    speed = np.linalg.norm(log.linear_velocity, axis=1)
    rate = np.linalg.norm(log.angular_velocity, axis=1)
    steps = np.linalg.norm(np.diff(log.position, axis=0), axis=1)
    values = (
        *log.position[-1],
        to_yaw(log.orientation[-1:])[0],
        tilt[-1],
        speed[-1],
        tilt.max(),
        speed.max(),
        rate.max(),
        steps.sum(),
    )
    return {name: float(value) for name, value in zip(UNITS, values)}
