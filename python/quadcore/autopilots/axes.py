"""Axes of autopilots of the north, east, down convention, such as PX4 and ArduPilot.

Body axes are forward, right, down; those of quadcore are forward, left, up. World axes are north,
east, down; those of quadcore are east, north, up.
"""

from __future__ import annotations

import math
from typing import List

import numpy as np


def turn_body_vector(vector: np.ndarray) -> List[float]:
    """Return the components of a vector in axes forward, right, down.

    Parameters
    ----------
    vector : ndarray (3,)
        Components in axes forward, left, up.
    """
    forward, left, up = vector.tolist()
    return [forward, -left, -up]


def turn_world_vector(vector: np.ndarray) -> List[float]:
    """Return the components of a vector in axes north, east, down.

    Parameters
    ----------
    vector : ndarray (3,)
        Components in axes east, north, up.
    """
    east, north, up = vector.tolist()
    return [north, east, -up]


def turn_orientation(orientation: np.ndarray) -> List[float]:
    """Return the quaternion w, x, y, z of axes forward, right, down in north, east, down.

    It is (i + j) q i / sqrt(2): half turns about north-east and about forward.

    Parameters
    ----------
    orientation : ndarray (4,)
        Unit quaternion x, y, z, w of axes forward, left, up in east, north, up.
    """
    x, y, z, w = orientation.tolist()
    half = math.sqrt(0.5)
    return [half * (w + z), half * (x + y), half * (x - y), half * (w - z)]


def turn_heading(yaw: float) -> float:
    """Return the heading clockwise from north of a yaw counter-clockwise from east, rad."""
    return math.remainder(0.5 * math.pi - yaw, 2 * math.pi)
