"""Bench that holds and turns a vehicle while an autopilot runs."""

from __future__ import annotations

import math
from typing import Any, List, Protocol, Sequence, Tuple

import numpy as np

from ..support.rotation import turn
from .autopilot import Autopilot
from .readings import read_held
from .sticks import Sticks

_LEVEL, _ORIGIN = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(3)


class Questions(Protocol):
    """Connection over which an autopilot answers questions."""

    def read_attitude(self) -> Tuple[float, float, float]:
        """Return the estimated roll, pitch and yaw, rad, for forward, left, up axes."""

    def set_motors(self, outputs: Sequence[float]) -> None:
        """Run the motors of a disarmed autopilot at these outputs, from 0 to 1."""

    def close(self) -> None:
        """Close the connection."""


class Bench:
    """Bench that holds and turns a vehicle; its rotors do not move it.

    Parameters
    ----------
    autopilot : Autopilot
        Autopilot that has already started.
    gravity : float
        Gravitational acceleration, m/s^2.
    """

    def __init__(self, autopilot: Autopilot, gravity: float) -> None:
        self._autopilot, self._gravity = autopilot, gravity
        self._time = -autopilot.hold
        self._orientation = _LEVEL
        self.sticks = self._sent = Sticks()
        self._ticks = 0
        self.outputs = np.zeros(len(autopilot.channels))

    @property
    def time(self) -> float:
        """Time, s; it counts from ``-hold``."""
        return self._time

    def hold(self, duration: float) -> None:
        """Hold the vehicle still for a duration (s)."""
        for _ in range(math.ceil(duration / self._autopilot.period)):
            self.tick()

    def turn(self, axis: int, angle: float, duration: float) -> List[np.ndarray]:
        """Turn the vehicle about a body axis, and return the outputs of each tick.

        Parameters
        ----------
        axis : int
            Body axis: 0 forward, 1 left, 2 up.
        angle : float
            Angle, rad.
        duration : float
            Duration, s.
        """
        ticks = math.ceil(duration / self._autopilot.period)
        step = np.zeros(3)
        step[axis] = angle / ticks
        outputs = []
        for _ in range(ticks):
            self._orientation = turn(self._orientation, step)
            self.tick(step / self._autopilot.period)
            outputs.append(self.outputs)
        return outputs

    def tick(self, angular_velocity: Any = (0.0, 0.0, 0.0)) -> None:
        """Let the autopilot compute one period."""
        readings = read_held(
            self._time, self._orientation, self._gravity, _ORIGIN, np.asarray(angular_velocity)
        )
        # A silent radio would disarm the autopilot.
        if self._ticks % self._autopilot.pilot_every == 0:
            self._sent = Sticks(*self.sticks)
        self._ticks += 1
        self.outputs = np.asarray(self._autopilot.tick(readings, self._sent), dtype=float)
        self._time += self._autopilot.period
