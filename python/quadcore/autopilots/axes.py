"""Axes of autopilots with the north, east, down convention, such as PX4 and ArduPilot.

Their body axes are forward, right, down; those of quadcore are forward, left, up. Their world axes
are north, east, down; those of quadcore are east, north, up.
"""

from __future__ import annotations

import math
from typing import List

import numpy as np


def turn_body_vector(vector: np.ndarray) -> List[float]:
    """Convert a vector to forward, right, down axes.

    Parameters
    ----------
    vector : ndarray (3,)
        Components in forward, left, up axes.
    """
    forward, left, up = vector.tolist()
    return [forward, -left, -up]


def turn_world_vector(vector: np.ndarray) -> List[float]:
    """Convert a vector to north, east, down axes.

    Parameters
    ----------
    vector : ndarray (3,)
        Components in east, north, up axes.
    """
    east, north, up = vector.tolist()
    return [north, east, -up]


def turn_orientation(orientation: np.ndarray) -> List[float]:
    """Return the quaternion w, x, y, z of forward, right, down axes in north, east, down axes.

    The result is (i + j) q i / sqrt(2): half turns about north-east and about forward.

    Parameters
    ----------
    orientation : ndarray (4,)
        Unit quaternion x, y, z, w of forward, left, up axes in east, north, up axes.
    """
    x, y, z, w = orientation.tolist()
    half = math.sqrt(0.5)
    return [half * (w + z), half * (x + y), half * (x - y), half * (w - z)]


def turn_heading(yaw: float) -> float:
    """Convert a yaw counter-clockwise from east to a heading clockwise from north, rad."""
    return math.remainder(0.5 * math.pi - yaw, 2 * math.pi)
