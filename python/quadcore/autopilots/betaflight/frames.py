"""Axes and signs of Betaflight's SITL, in one function.

Betaflight's `src/platform/SIMULATOR/sitl.c` (commit 301d01a, default build with
``ENABLE_GAZEBO_BRIDGE`` 1) reads a packet of state as follows. Its body axes are forward, left, up.

- angular velocity p: gyro = (p_x, -p_y, p_z)
- acceleration a: accelerometer = -a, the specific force
- quaternion q = (w, x, y, z): attitude in north, west, up = Rz(90 deg) (w, x, -y, -z)
- position (lon, lat, alt): mirrored about the first packet's, so that the east and the north of
  later packets change sign
- velocity: east, north, up

The functions below are the inverse of these rules.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Tuple

import numpy as np

from ..readings import Readings

_METRES_PER_DEGREE = 111319.49  # at the equator, 2 pi 6378137 m / 360
_PRESSURE = 101325.0  # Pa; the default build computes it from the altitude


class Place(NamedTuple):
    """Place on Earth of the world's origin."""

    latitude: float = 47.3977
    """deg"""
    longitude: float = 8.5456
    """deg"""
    altitude: float = 488.0
    """m above the sea"""


def convert_readings(readings: Readings, first: np.ndarray, place: Place) -> Tuple[float, ...]:
    """Return the fields of Betaflight's packet of state, without its time.

    Parameters
    ----------
    readings : Readings
        Readings of the sensors.
    first : ndarray (3,)
        Position in the first packet, m.
    place : Place
        Place of the world's origin.

    Returns
    -------
    tuple of 17 floats
        Angular velocity (rad/s), acceleration (m/s^2), quaternion w, x, y, z, velocity (m/s),
        longitude, latitude (deg), altitude (m), pressure (Pa).
    """
    wx, wy, wz = readings.angular_velocity.tolist()
    ax, ay, az = readings.specific_force.tolist()
    x, y, z, w = readings.orientation.tolist()
    east, north, up = readings.position.tolist()
    first_east, first_north = float(first[0]), float(first[1])
    per_east = 1 / (_METRES_PER_DEGREE * math.cos(math.radians(place.latitude)))
    return (
        *(wx, -wy, wz),
        *(-ax, -ay, -az),
        *(-z, -y, -x, -w),  # Rz(180 deg) q = (-z, -y, x, w), then y and z change sign
        *readings.linear_velocity.tolist(),
        place.longitude + (2 * first_east - east) * per_east,
        place.latitude + (2 * first_north - north) / _METRES_PER_DEGREE,
        place.altitude + up,
        _PRESSURE,
    )
