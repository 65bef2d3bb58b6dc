"""What is measured of a flight that follows no reference."""

from __future__ import annotations

from typing import Dict

import numpy as np

from ...simulation.log import Log
from ...support.rotation import roll_pitch_yaw

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
"""Of each measure, by name."""

MEANINGS = {
    "final_x": "position of the frame at the end",
    "final_y": "",
    "final_z": "",
    "final_yaw": "heading at the end",
    "final_tilt": "angle between the frame's z and the world's at the end",
    "final_speed": "of the frame's origin at the end",
    "max_tilt": "over the flight",
    "max_speed": "over the flight",
    "max_rate": "length of the angular velocity, over the flight",
    "travelled": "length of the way",
}


def measure(log: Log) -> Dict[str, float]:
    """Give a number for each of `UNITS`."""
    x, y = log.orientation[:, 0], log.orientation[:, 1]
    tilt = 2 * np.arcsin(np.minimum(1, np.hypot(x, y)))  # of the quaternion: exact near 0
    speed = np.linalg.norm(log.linear_velocity, axis=1)
    rate = np.linalg.norm(log.angular_velocity, axis=1)
    steps = np.linalg.norm(np.diff(log.position, axis=0), axis=1)
    values = (
        *log.position[-1],
        roll_pitch_yaw(log.orientation[-1:])[0, 2],
        tilt[-1],
        speed[-1],
        tilt.max(),
        speed.max(),
        rate.max(),
        steps.sum(),
    )
    return {name: float(value) for name, value in zip(UNITS, values)}
