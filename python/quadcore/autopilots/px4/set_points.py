"""Set-points and commands for PX4's offboard mode."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...support.rotation import to_matrix
from ..axes import turn_heading, turn_world_vector
from ..readings import Readings

OFFBOARD = 6
"""Main mode in which PX4 follows set-points."""

_CUSTOM_MODE = 1  # MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
_AUTOPILOT = 1  # target component
_ALL = 0  # target system: all


class SetPoints:
    """Makes set-points relative to the position at which PX4 started.

    Parameters
    ----------
    mavlink : module
        Dialect of pymavlink.
    target : int
        System number of PX4.
    readings : Readings
        Readings of the first tick.
    """

    def __init__(self, mavlink: Any, target: int, readings: Readings) -> None:
        self._mavlink, self._target = mavlink, target
        self.origin = readings.position
        forward = to_matrix(readings.orientation)[:, 0]
        self._yaw = float(np.arctan2(forward[1], forward[0]))

    def follow(self, time: int, reference: Any) -> Any:
        """Return the set-point for a reference; None: the initial position and heading.

        Parameters
        ----------
        time
            Time of PX4, ms.
        reference
            Value of the reference: position (m), velocity, acceleration, yaw and yaw rate.
        """
        yaw, rate, zero = self._yaw, 0.0, np.zeros(3)
        position = velocity = acceleration = zero
        if reference is not None:
            position = np.asarray(reference.position) - self.origin
            velocity = np.asarray(reference.velocity)
            acceleration = np.asarray(reference.acceleration)
            yaw, rate = reference.yaw, reference.yaw_rate
        return self._mavlink.MAVLink_set_position_target_local_ned_message(
            time,
            _ALL,  # independent of the instance number, for recorded sessions
            _AUTOPILOT,
            self._mavlink.MAV_FRAME_LOCAL_NED,
            0,  # all fields are valid
            *turn_world_vector(position),
            *turn_world_vector(velocity),
            *turn_world_vector(acceleration),
            turn_heading(yaw),
            -rate,
        )

    def choose_offboard(self) -> Any:
        """Return the command that selects the offboard mode."""
        return self._command(self._mavlink.MAV_CMD_DO_SET_MODE, _CUSTOM_MODE, OFFBOARD)

    def arm(self) -> Any:
        """Return the command to arm."""
        return self._command(self._mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1, 0)

    def _command(self, number: int, first: float, second: float) -> Any:
        return self._mavlink.MAVLink_command_long_message(
            self._target, _AUTOPILOT, number, 0, first, second, 0, 0, 0, 0, 0
        )
