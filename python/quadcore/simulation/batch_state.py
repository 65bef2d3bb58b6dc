"""States of all vehicles of a batch."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ..support.values import FloatArray


class BatchState(NamedTuple):
    """States of the vehicles of a batch; each row belongs to one vehicle.

    Attributes
    ----------
    position : ndarray (n, 3)
        Positions of the frame origins in the world, m.
    orientation : ndarray (n, 4)
        Orientations of the frames in the world, unit quaternions x, y, z, w.
    linear_velocity : ndarray (n, 3)
        Velocities of the frame origins, world axes, m/s.
    angular_velocity : ndarray (n, 3)
        Angular velocities of the frames, body axes, rad/s.
    rotor_velocity : ndarray (n, rotors)
        Joint velocities in the engine, after the division by sim_slow, rad/s.
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
        """Split rows of states into named columns without copying.

        Parameters
        ----------
        rows : ndarray (n, 13 + 2 rotors)
            Rows in the format of `BatchSimulation.read_state`.
        """
        of_frame = [3, 4, 3, 3]
        rotors = (rows.shape[1] - sum(of_frame)) // 2
        ends = np.cumsum([*of_frame, rotors])
        return cls(*np.split(rows, ends, axis=1))
