"""Pilot that follows a reference with the sticks of a radio."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..control.vehicle import Vehicle
from ..support.rotation import to_matrix, to_roll_pitch_yaw
from .motor_curve import MotorCurve

_POSITION, _VELOCITY, _INTEGRAL, _HEADING = 2.0, 2.4, 0.5, 2.0  # 1/s^2, 1/s, 1/s, 1/s
_MOST = 3.0  # m/s^2; limit of the integral


class Sticks(NamedTuple):
    """Positions of the sticks of a radio; roll, pitch and yaw are from -1 to 1."""

    roll: float = 0.0
    """Positive rolls to the right."""
    pitch: float = 0.0
    """Positive lowers the nose."""
    yaw: float = 0.0
    """Positive turns clockwise, seen from above."""
    throttle: float = 0.0
    """From 0 to 1."""
    is_armed: bool = False
    """Position of the arming switch."""


class StickPilot:
    """Controls position with the sticks of an autopilot that levels itself.

    A PID controller with feed-forward gives the acceleration. The direction of the thrust gives
    roll and pitch, and its magnitude the throttle. The gains suit an attitude response of about
    0.15 s.

    Parameters
    ----------
    vehicle : Vehicle
        Vehicle to fly.
    curve : MotorCurve
        Motor curve of the vehicle.
    period : float
        Time between calls, s.
    max_angle : float
        Angle of a full roll or pitch stick, rad.
    max_yaw_rate : float
        Yaw rate of a full yaw stick, rad/s.
    idle : float
        Output of an armed motor without throttle, from 0 to 1.
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
        self._mass, self._gravity = vehicle.mass, vehicle.gravity
        self._lift = float(np.sum(vehicle.thrust_coefficients * vehicle.rotor_axes[:, 2]))
        self._curve, self._period, self._idle = curve, period, idle
        self._max_angle, self._max_yaw_rate = max_angle, max_yaw_rate
        self._count = vehicle.rotor_count
        self._integral = np.zeros(3)

    @property
    def hover(self) -> Sticks:
        """Sticks of a level hover, armed."""
        throttle = self._find_throttle(self._mass * self._gravity)
        return Sticks(throttle=throttle, is_armed=True)

    def fly(self, state: Any, reference: Any) -> Sticks:
        """Return the sticks that lead to a reference.

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
        # The integral of the feedback over a move from rest to rest is 0: it does not overshoot.
        change = self._period * _INTEGRAL * feedback
        self._integral = np.clip(self._integral + change, -_MOST, _MOST)
        force = self._mass * (wanted + np.array([0, 0, self._gravity]))
        force[2] = max(force[2], 0.2 * self._mass * self._gravity)  # never upside down
        yaw = float(to_roll_pitch_yaw(state.orientation)[2])
        c, s = np.cos(yaw), np.sin(yaw)
        forward, left = c * force[0] + s * force[1], -s * force[0] + c * force[1]
        pitch = np.arctan2(forward, force[2])
        roll = -np.arctan2(left, np.hypot(forward, force[2]))
        thrust = float(force @ to_matrix(state.orientation)[:, 2])
        turn = (reference.yaw - yaw + np.pi) % (2 * np.pi) - np.pi
        rate = reference.yaw_rate + _HEADING * turn
        return Sticks(
            float(np.clip(roll / self._max_angle, -1, 1)),
            float(np.clip(pitch / self._max_angle, -1, 1)),
            float(np.clip(-rate / self._max_yaw_rate, -1, 1)),
            self._find_throttle(thrust),
            True,
        )

    def _find_throttle(self, thrust: float) -> float:
        """Return the throttle at which the rotors exert a thrust (N)."""
        speed = np.sqrt(max(thrust, 0.0) / self._lift)
        output = float(np.mean(self._curve.find_outputs(np.full(self._count, speed))))
        return min(max((output - self._idle) / (1 - self._idle), 0.0), 1.0)
