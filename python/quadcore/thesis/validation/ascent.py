"""Open-loop input: an ascent with successive rotations about all axes."""

from __future__ import annotations

import numpy as np

from ..._core import InputError
from ..chapter2 import Vehicle, matrices

CLIMB = 1.04  # ratio of thrust to weight
TILT, TURN = np.radians([2.0, 10.0])

# Each move rotates the vehicle by a multiple of TILT or TURN, with a torque in one direction and
# then in the other. An entry contains the start of the move and the duration of each half (s), the
# axis and the multiple. The rotations alternate in direction, because drag makes the open loop
# unstable and small angles limit its growth.
PATTERN = (1, -2, 1, -1, 2, -1)
MOVES = (
    *((t, 0.2, 0, turn) for t, turn in zip((2, 3, 4, 6, 7, 8), PATTERN)),
    *((t, 0.2, 1, turn) for t, turn in zip((2.5, 3.5, 4.5, 6.5, 7.5, 8.5), PATTERN)),
    *((t, 0.4, 2, turn) for t, turn in zip((1, 5, 9), (1, -2, 1))),
)


def make_ascent(vehicle: Vehicle) -> np.ndarray:
    """Make rotor speeds that lift, tilt and yaw a vehicle for ten seconds.

    The signs of the speeds alternate along the command. The quadrotor of the thesis tilts by 2
    degrees without drag, and by 43 degrees with all drags. The reason is that drag above the centre
    of mass makes it unstable.

    Returns
    -------
    ndarray, shape (rows, 1 + n)
        Time (s) and signed speeds (rad/s), as for `Simulation.run`.

    Raises
    ------
    InputError
        If such speeds cannot lift, tilt or yaw the vehicle.
    """
    spin = np.where(np.arange(len(vehicle.arms)) % 2 == 0, 1.0, -1.0)
    # Lift and torques per squared speed at level attitude; lateral forces are ignored.
    effect = matrices.K_zeta(vehicle, np.zeros(6), spin)[2:]
    _check_authority(effect)
    lift = -CLIMB * vehicle.mass * vehicle.gravity[2]
    angles = np.array([TILT, TILT, TURN]) * np.diag(vehicle.inertia)
    bends = {0.0: np.zeros(3)}
    for start, half, axis, turn in MOVES:
        torque = angles * turn / half**2 * (np.arange(3) == axis)
        for t, value in ((start, torque), (start + half, -torque), (start + 2 * half, 0 * torque)):
            bends[round(t, 9)] = value
    rows = []
    for t, torque in sorted(bends.items(), key=lambda bend: bend[0]):
        wanted = np.array([lift, *torque])
        squares, *_ = np.linalg.lstsq(effect, wanted, rcond=None)
        if squares.min() < 0:
            about = "xyz"[int(np.abs(torque).argmax())]
            turning = f"turn it about {about} as fast as the built-in flight does"
            raise InputError(
                "rotors that spin + - + - cannot lift this vehicle and "
                f"{turning if torque.any() else 'keep it level'}. Give --commands."
            )
        rows.append([t, *(spin * np.sqrt(squares))])
    return np.array(rows)


def _check_authority(effect: np.ndarray) -> None:
    """Raise `InputError` unless the rows of `effect` (lift and torques) are independent."""
    for row, what in enumerate(("lift", "torque about x", "torque about y", "torque about z")):
        alone = np.eye(4)[row]
        squares, *_ = np.linalg.lstsq(effect, alone, rcond=None)
        if not np.allclose(effect @ squares, alone, atol=1e-6):
            raise InputError(
                f"rotors that spin + - + - give this vehicle no {what} without another force or "
                "torque, which the built-in flight needs. Give --commands."
            )
