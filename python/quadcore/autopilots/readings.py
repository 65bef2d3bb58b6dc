"""Sensor readings for an autopilot."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from .._core import InputError
from ..support.rotation import to_matrix


class Readings(NamedTuple):
    """Readings at one tick; body axes are forward, left, up.

    Attributes
    ----------
    time : float
        Time of the reading, s; negative before the flight.
    position : ndarray (3,)
        Position of the frame's origin, world axes, m.
    linear_velocity : ndarray (3,)
        Velocity of the frame's origin, world axes, m/s.
    orientation : ndarray (4,)
        Orientation of the frame in the world, unit quaternion x, y, z, w.
    angular_velocity : ndarray (3,)
        Angular velocity, body axes, rad/s.
    specific_force : ndarray (3,)
        Acceleration minus gravity, body axes, m/s^2; about (0, 0, 9.8) at rest.
    """

    time: float
    position: np.ndarray
    linear_velocity: np.ndarray
    orientation: np.ndarray
    angular_velocity: np.ndarray
    specific_force: np.ndarray


def read_held(
    time: float,
    orientation: np.ndarray,
    gravity: float,
    position: np.ndarray,
    angular_velocity: np.ndarray,
) -> Readings:
    """Return the readings of a vehicle that is held at a position, and optionally turned.

    Parameters
    ----------
    time : float
        Time of the readings, s.
    orientation : ndarray (4,)
        Orientation, unit quaternion x, y, z, w.
    gravity : float
        Gravitational acceleration, m/s^2.
    position : ndarray (3,)
        Position, m.
    angular_velocity : ndarray (3,)
        Angular velocity, body axes, rad/s.
    """
    up = to_matrix(orientation)[2]
    return Readings(time, position, np.zeros(3), orientation, angular_velocity, gravity * up)


class Sensors:
    """Reads the sensors of a simulation.

    Parameters
    ----------
    simulation : Simulation
        Simulation of the vehicle.
    imu : str
        Topic of the IMU. "" selects ideal readings: the angular velocity of the state, and the mean
        specific force since the last reading.

    Raises
    ------
    InputError
        If no plugin publishes an IMU on the topic.
    """

    def __init__(self, simulation: Any, imu: str) -> None:
        self._simulation, self._imu = simulation, imu
        self._gravity = -float(simulation.gravity[2])
        self._before: Optional[Readings] = None
        topic = simulation.topics.get(imu)
        if imu and (topic is None or topic.kind != "imu" or topic.writer is None):
            known = [name for name, each in simulation.topics.items() if each.kind == "imu"]
            names = f"Use one of {', '.join(known)}." if known else "Add libimu_plugin.so."
            raise InputError(f"imu: no plugin publishes an IMU on topic '{imu}'. {names}")

    @property
    def gravity(self) -> float:
        """Gravitational acceleration along -z of the world, m/s^2."""
        return self._gravity

    def read(self, time: float) -> Readings:
        """Return the readings for the current state."""
        state = self._simulation.state
        new = Readings(
            time,
            state.position.copy(),
            state.linear_velocity.copy(),
            state.orientation.copy(),
            state.angular_velocity.copy(),
            np.empty(0),
        )
        before, self._before = self._before, new
        if before is None:
            return read_held(
                time, new.orientation, self._gravity, new.position, new.angular_velocity
            )._replace(linear_velocity=new.linear_velocity)
        if self._imu:
            message = self._simulation.topic(self._imu)
            return new._replace(
                angular_velocity=np.array([message[name] for name in ("wx", "wy", "wz")]),
                specific_force=np.array([message[name] for name in ("ax", "ay", "az")]),
            )
        force = (new.linear_velocity - before.linear_velocity) / (time - before.time)
        force[2] += self._gravity
        return new._replace(specific_force=to_matrix(new.orientation).T @ force)
