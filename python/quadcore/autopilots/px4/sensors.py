"""Sensors of PX4's simulator interface: the MAVLink packets HIL_SENSOR and HIL_GPS.

PX4 reads them in ``src/modules/simulator/simulator_mavlink.cpp`` (commit 34160bb6). Body axes are
forward, right, down. PX4 treats sensors with constant values as broken, so each sensor has noise.
"""

from __future__ import annotations

import math
from typing import Any, List

import numpy as np

from ...model.earth import Location
from ...support.rotation import to_matrix
from ..axes import turn_body_vector, turn_world_vector
from ..readings import Readings

_GYROSCOPE = 0.001  # rad/s; standard deviations of the noise
_ACCELEROMETER = 0.02  # m/s^2
_MAGNETOMETER = 0.0005  # Gauss
_BAROMETER = 0.005  # hPa, about 4 cm
_SEED = 4  # seed of the noise, equal in every flight

_IMU, _FIELD, _AIR = 0x3F, 0x1C0, 0x1A00  # fields_updated; _AIR excludes the dynamic pressure
_GAUSS = 1e4  # per T
_FIX_3D, _SATELLITES, _ACCURACY = 3, 10, 30  # accuracy, cm


class SensorPackets:
    """Makes the sensor packets.

    Parameters
    ----------
    mavlink : module
        Dialect of pymavlink.
    field : ndarray (3,)
        Magnetic field, world axes, T.
    location : Location
        Location of the world's origin.
    """

    def __init__(self, mavlink: Any, field: np.ndarray, location: Location) -> None:
        self._mavlink, self._location = mavlink, location
        self._field = np.asarray(field) * _GAUSS
        self.restart()

    def restart(self) -> None:
        """Restart the noise, so that a flight does not depend on the phase before it."""
        self._random = np.random.default_rng(_SEED)

    def read_sensor(self, time: int, readings: Readings, has_air: bool) -> Any:
        """Return HIL_SENSOR with the IMU and the magnetometer, and optionally the barometer.

        Parameters
        ----------
        time
            Time of PX4, us.
        readings
            Readings of the vehicle.
        has_air
            Whether the barometer has a new reading.
        """
        noise = self._random.standard_normal(10)
        up = to_matrix(readings.orientation)
        field = turn_body_vector(up.T @ self._field + _MAGNETOMETER * noise[6:9])
        altitude = self._location.altitude + float(readings.position[2])
        pressure = find_pressure(altitude) + _BAROMETER * float(noise[9])
        return self._mavlink.MAVLink_hil_sensor_message(
            time,
            *turn_body_vector(readings.specific_force + _ACCELEROMETER * noise[0:3]),
            *turn_body_vector(readings.angular_velocity + _GYROSCOPE * noise[3:6]),
            *field,
            pressure,
            0.0,
            altitude,
            15.0,
            _IMU | _FIELD | (_AIR if has_air else 0),
        )

    def read_gps(self, time: int, readings: Readings) -> Any:
        """Return HIL_GPS; the arguments are those of `read_sensor`."""
        latitude, longitude, altitude = self._location.locate(*readings.position.tolist())
        north, east, down = turn_world_vector(100 * readings.linear_velocity)
        course = math.degrees(math.atan2(east, north)) % 360
        return self._mavlink.MAVLink_hil_gps_message(
            time,
            _FIX_3D,
            round(latitude * 1e7),
            round(longitude * 1e7),
            round(altitude * 1e3),
            _ACCURACY,
            _ACCURACY,
            round(math.hypot(north, east)),
            *_round_all(north, east, down),
            round(course * 100) % 36000,
            _SATELLITES,
        )


def find_pressure(altitude: float) -> float:
    """Return the pressure of the standard atmosphere (ISO 2533) up to 11 km, hPa.

    Parameters
    ----------
    altitude
        Altitude above sea level, m.
    """
    return float(1013.25 * (1 - 0.0065 * altitude / 288.15) ** 5.25588)


def _round_all(*values: float) -> List[int]:
    return [round(value) for value in values]
