"""Conversion to the axes and signs of Betaflight's SITL.

Betaflight's `src/platform/SIMULATOR/sitl.c` (commit 301d01a, default build with
``ENABLE_GAZEBO_BRIDGE`` 1) interprets a state packet as follows. Its body axes are forward, left,
up.

- angular velocity p: gyro = (p_x, -p_y, p_z)
- acceleration a: accelerometer = -a, which is the specific force
- quaternion q = (w, x, y, z): attitude in north, west, up axes = Rz(90 deg) (w, x, -y, -z)
- position (lon, lat, alt): mirrored about the first packet, so east and north of later packets
  change sign
- velocity: east, north, up

The functions below are the inverse of these rules.
"""

from __future__ import annotations

from typing import Tuple

import numpy as np

from ...model.earth import Location
from ..readings import Readings

_PRESSURE = 101325.0  # Pa; the default build computes the pressure from the altitude


def convert_readings(
    readings: Readings, first: np.ndarray, location: Location
) -> Tuple[float, ...]:
    """Return the fields of Betaflight's state packet, except for its time.

    Parameters
    ----------
    readings : Readings
        Readings of the sensors.
    first : ndarray (3,)
        Position in the first packet, m.
    location : Location
        Location of the world's origin.

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
    latitude, longitude, altitude = location.locate(
        2 * first_east - east, 2 * first_north - north, up
    )
    return (
        *(wx, -wy, wz),
        *(-ax, -ay, -az),
        *(-z, -y, -x, -w),  # Rz(180 deg) q = (-z, -y, x, w), with the signs of y and z changed
        *readings.linear_velocity.tolist(),
        longitude,
        latitude,
        altitude,
        _PRESSURE,
    )
