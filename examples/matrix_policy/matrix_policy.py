"""A controller in NumPy that commands all seeds of a study at once.

The policy is one matrix: the rotor speeds are those of hover plus the matrix times the errors of
height, attitude and velocities. It holds the height and stays level, but not the place.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_HEIGHT, _CLIMB = 20.0, 15.0  # rad/s per m, per m/s
_TILT, _TILT_RATE = 400.0, 60.0  # rad/s per m of arm and rad, per m of arm and rad/s
_YAW_RATE = 5.0  # rad/s per rad/s


class Policy:
    """Hold the height of the reference, for any number of vehicles."""

    vectorized = True

    def reset(self, simulation: Any) -> None:
        """Prepare for flights of this vehicle."""
        rotors = simulation.rotors
        self._hover = np.abs(simulation.hover_speed)
        self._spins = np.sign(simulation.hover_speed)
        x, y, _ = np.array([rotor.position for rotor in rotors]).T
        ones, sense = np.ones(len(rotors)), np.array([rotor.torque_sense for rotor in rotors])
        self._matrix = np.array(
            [
                _HEIGHT * ones,
                _CLIMB * ones,
                -_TILT * y,
                _TILT * x,
                -_TILT_RATE * y,
                _TILT_RATE * x,
                -_YAW_RATE * sense * self._spins,
            ]
        )

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Return the rotor speeds (n, rotors), rad/s, for states of n vehicles."""
        errors = np.column_stack(
            [
                reference.position[:, 2] - state.position[:, 2],
                reference.velocity[:, 2] - state.linear_velocity[:, 2],
                2 * state.orientation[:, :2],
                state.angular_velocity,
            ]
        )
        speeds: np.ndarray = (self._hover + errors @ self._matrix) * self._spins
        return speeds
