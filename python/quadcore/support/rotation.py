"""Rotations: Euler angles, matrices and quaternions."""

from __future__ import annotations

import numpy as np


def to_roll_pitch_yaw(orientation: np.ndarray) -> np.ndarray:
    """Return roll phi, pitch theta and yaw psi, with R = Rz(psi) Ry(theta) Rx(phi).

    Parameters
    ----------
    orientation : ndarray, shape (..., 4)
        Unit quaternions x, y, z, w of the frame in the world.

    Returns
    -------
    ndarray, shape (..., 3)
        Angles, rad; roll and yaw in [-pi, pi], pitch in [-pi/2, pi/2].
    """
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    return np.stack([roll, pitch, to_yaw(orientation)], axis=-1)


def to_yaw(orientation: np.ndarray) -> np.ndarray:
    """Return the yaw angle of `to_roll_pitch_yaw`, rad; shape (...)."""
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    yaw: np.ndarray = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return yaw


def compute_tilts(orientation: np.ndarray) -> np.ndarray:
    """Return the angles between the z axes of the frame and the world, rad.

    Parameters
    ----------
    orientation : ndarray, shape (rows, 4)
        Unit quaternions x, y, z, w of the frame in the world.
    """
    x, y = orientation[:, 0], orientation[:, 1]
    # The formula with the quaternion is exact near 0.
    tilts: np.ndarray = 2 * np.arcsin(np.minimum(1, np.hypot(x, y)))
    return tilts


def unwrap_angles(angles: np.ndarray) -> np.ndarray:
    """Remove the jumps from the roll, pitch and yaw angles of a motion.

    An attitude has two equivalent triples of angles, ``(r, p, y)`` and ``(r + pi, pi - p, y +
    pi)``, plus multiples of 2 pi. In each row, the values closest to the previous row are used.

    Parameters
    ----------
    angles : ndarray (rows, 3)
        Roll, pitch and yaw from `to_roll_pitch_yaw`, rad.

    Returns
    -------
    ndarray (rows, 3)
        Roll, pitch and yaw without jumps, rad; pitch may exceed [-pi/2, pi/2].
    """
    stays = _measure_distance(angles[1:], angles[:-1]) <= _measure_distance(
        _flip(angles[1:]), angles[:-1]
    )
    is_flipped = np.concatenate([[False], np.cumsum(~stays) % 2 == 1])[: len(angles)]
    nearest = np.where(is_flipped[:, None], _flip(angles), angles)
    return np.asarray(np.unwrap(nearest, axis=0))


def subtract_angles(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Subtract roll, pitch and yaw, using the nearer equivalent triples, rad; shape (rows, 3)."""
    is_near = _measure_distance(one, other) <= _measure_distance(_flip(one), other)
    nearest = np.where(is_near[:, None], one, _flip(one))
    return _wrap(nearest - other)


def _flip(angles: np.ndarray) -> np.ndarray:
    return np.stack([angles[:, 0] + np.pi, np.pi - angles[:, 1], angles[:, 2] + np.pi], axis=1)


def _wrap(angles: np.ndarray) -> np.ndarray:
    wrapped: np.ndarray = np.remainder(angles + np.pi, 2 * np.pi) - np.pi
    return wrapped


def _measure_distance(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.asarray(np.abs(_wrap(one - other)).sum(axis=1))


def to_matrix(orientation: np.ndarray) -> np.ndarray:
    """Return the matrices R_WF, which transform vectors from frame axes to world axes.

    Parameters
    ----------
    orientation : ndarray, shape (..., 4)
        Unit quaternions x, y, z, w of the frame in the world.

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    values = np.asarray(orientation, dtype=float)
    is_single = values.ndim == 1  # ten times faster with floats than with arrays of length one
    x, y, z, w = values.tolist() if is_single else np.moveaxis(values, -1, 0)
    entries = [
        *[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        *[2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        *[2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    if is_single:
        return np.array(entries).reshape(3, 3)
    return np.stack(entries, axis=-1).reshape((*x.shape, 3, 3))


def compose_roll_pitch_yaw(angles: np.ndarray) -> np.ndarray:
    """Return the matrix Rz(yaw) Ry(pitch) Rx(roll) of a URDF origin.

    Parameters
    ----------
    angles : ndarray (3,)
        Roll, pitch and yaw, rad.

    Returns
    -------
    ndarray (3, 3)
    """
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles), np.sin(angles)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def compute_rotation_vector(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the rotation vector from one orientation to another, in axes of the first, rad.

    Parameters
    ----------
    first, second : ndarray (4,)
        Unit quaternions x, y, z, w.
    """
    v, w = first[:3], first[3]
    scalar = w * second[3] + v @ second[:3]
    vector = w * second[:3] - second[3] * v - np.cross(v, second[:3])
    if scalar < 0:
        vector = -vector
    sine = float(np.linalg.norm(vector))
    angle = 2 * np.arctan2(sine, abs(scalar))
    return np.asarray(vector * (angle / sine if sine > 0 else 2.0))


def turn(orientation: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Rotate a body by a rotation vector in body axes.

    Parameters
    ----------
    orientation : ndarray (4,)
        Unit quaternion x, y, z, w.
    angle : ndarray (3,)
        Rotation vector, rad; not zero.

    Returns
    -------
    ndarray (4,)
        Unit quaternion x, y, z, w.
    """
    size = float(np.linalg.norm(angle))
    v, w = np.sin(size / 2) * angle / size, np.cos(size / 2)
    vector = orientation[3] * v + w * orientation[:3] + np.cross(orientation[:3], v)
    return np.array([*vector, orientation[3] * w - orientation[:3] @ v])
