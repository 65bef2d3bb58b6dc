"""The states of many vehicles."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ..support.values import FloatArray


class BatchState(NamedTuple):
    """The states of the vehicles of a batch, a row for each.

    Attributes
    ----------
    position : ndarray (n, 3)
        Frame origins in the world, m.
    orientation : ndarray (n, 4)
        Of the frames in the world, unit quaternions x, y, z, w.
    linear_velocity : ndarray (n, 3)
        Of the frame origins, world axes, m/s.
    angular_velocity : ndarray (n, 3)
        Of the frames, body axes, rad/s.
    rotor_velocity : ndarray (n, rotors)
        Joint velocities as the engine has them, rad/s.
    rotor_angle : ndarray (n, rotors)
        Joint angles in (-pi, pi], rad.
    """

    position: FloatArray
    orientation: FloatArray
    linear_velocity: FloatArray
    angular_velocity: FloatArray
    rotor_velocity: FloatArray
    rotor_angle: FloatArray

    @classmethod
    def of(cls, rows: np.ndarray) -> BatchState:
        """Name the columns of rows, without a copy.

        Parameters
        ----------
        rows : ndarray (n, 13 + 2 rotors)
            As `BatchSimulation.read_state` writes them.
        """
        rotors = (rows.shape[1] - 13) // 2
        ends = np.cumsum([3, 4, 3, 3, rotors])
        return cls(*np.split(rows, ends, axis=1))
