"""Pilot that follows a reference with the sticks of a radio."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..control.vehicle import Vehicle
from ..support.rotation import to_matrix
from .motor_curve import MotorCurve

_POSITION, _VELOCITY, _INTEGRAL, _HEADING = 2.0, 2.4, 0.5, 2.0  # 1/s^2, 1/s, 1/s, 1/s
_MOST = 3.0  # m/s^2; limit of the integral


class Sticks(NamedTuple):
    """Stick positions of a radio; roll, pitch and yaw range from -1 to 1."""

    roll: float = 0.0
    """Positive values roll to the right."""
    pitch: float = 0.0
    """Positive values lower the nose."""
    yaw: float = 0.0
    """Positive values turn clockwise, seen from above."""
    throttle: float = 0.0
    """Throttle from 0 to 1."""
    is_armed: bool = False
    """Position of the arming switch."""


class StickPilot:
    """Position controller that moves the sticks of a self-levelling autopilot.

    A PID controller with feed-forward computes the acceleration. The direction of the thrust
    determines roll and pitch, and its magnitude determines the throttle. The gains suit an attitude
    response time of about 0.15 s.

    Parameters
    ----------
    vehicle : Vehicle
        Vehicle to control.
    curve : MotorCurve
        Motor curve of the vehicle.
    period : float
        Time between calls, s.
    max_angle : float
        Angle at full roll or pitch stick, rad.
    max_yaw_rate : float
        Yaw rate at full yaw stick, rad/s.
    idle : float
        Output of an armed motor at zero throttle, from 0 to 1.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        curve: MotorCurve,
        period: float,
        max_angle: float,
        max_yaw_rate: float,
        idle: float,
    ) -> None:
        self._mass, self._gravity = vehicle.mass, -float(vehicle.gravity[2])
        self._lift = float(np.sum(vehicle.thrust_coefficients * vehicle.rotor_axes[:, 2]))
        self._curve, self._period, self._idle = curve, period, idle
        self._max_angle, self._max_yaw_rate = max_angle, max_yaw_rate
        self._count = vehicle.rotor_count
        self._integral = np.zeros(3)

    @property
    def hover(self) -> Sticks:
        """Stick positions for level hover, with the vehicle armed."""
        throttle = self._find_throttle(self._mass * self._gravity)
        return Sticks(throttle=throttle, is_armed=True)

    def fly(self, state: Any, reference: Any) -> Sticks:
        """Return the sticks that follow a reference.

        Parameters
        ----------
        state : Odometry
            Latest odometry.
        reference : Reference
            Value of the reference.
        """
        error = np.asarray(reference.position) - state.position
        slip = np.asarray(reference.velocity) - state.linear_velocity
        feedback = _POSITION * error + _VELOCITY * slip
        wanted = np.asarray(reference.acceleration) + feedback + self._integral
        # The integral of the feedback over a move from rest to rest is 0, so the move does not
        # overshoot.
        change = self._period * _INTEGRAL * feedback
        self._integral = np.minimum(np.maximum(self._integral + change, -_MOST), _MOST)
        force = self._mass * (wanted + np.array([0, 0, self._gravity]))
        force[2] = max(force[2], 0.2 * self._mass * self._gravity)  # never upside down
        rotation = to_matrix(state.orientation)
        thrust = float(force @ rotation[:, 2])
        yaw = math.atan2(rotation[1, 0], rotation[0, 0])
        c, s = math.cos(yaw), math.sin(yaw)
        x, y, up = force.tolist()
        forward, left = c * x + s * y, -s * x + c * y
        pitch = math.atan2(forward, up)
        roll = -math.atan2(left, math.hypot(forward, up))
        turn = (reference.yaw - yaw + math.pi) % (2 * math.pi) - math.pi
        rate = reference.yaw_rate + _HEADING * turn
        return Sticks(
            _limit(roll / self._max_angle),
            _limit(pitch / self._max_angle),
            _limit(-rate / self._max_yaw_rate),
            self._find_throttle(thrust),
            True,
        )

    def _find_throttle(self, thrust: float) -> float:
        """Return the throttle at which the rotors produce a thrust (N)."""
        speed = np.sqrt(max(thrust, 0.0) / self._lift)
        output = float(np.mean(self._curve.find_outputs(np.full(self._count, speed))))
        return min(max((output - self._idle) / (1 - self._idle), 0.0), 1.0)


def _limit(stick: float) -> float:
    return min(max(stick, -1.0), 1.0)
