"""Angles of an orientation."""

from __future__ import annotations

import numpy as np


def roll_pitch_yaw(orientation: np.ndarray) -> np.ndarray:
    """Roll phi, pitch theta and yaw psi, with R = Rz(psi) Ry(theta) Rx(phi).

    Parameters
    ----------
    orientation : ndarray, shape (..., 4)
        Unit quaternions x, y, z, w of the frame in the world.

    Returns
    -------
    ndarray, shape (..., 3)
        rad; roll and yaw in [-pi, pi], pitch in [-pi/2, pi/2].
    """
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return np.stack([roll, pitch, yaw], axis=-1)


def matrix(orientation: np.ndarray) -> np.ndarray:
    """Give the matrices R_WF that turn vectors from frame axes to world axes.

    Parameters
    ----------
    orientation : ndarray, shape (..., 4)
        Unit quaternions x, y, z, w of the frame in the world.

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    entries = [
        *[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        *[2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        *[2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack(entries, axis=-1).reshape((*x.shape, 3, 3))


def turned(orientation: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Turn a body about an axis of its own.

    Parameters
    ----------
    orientation : ndarray (4,)
        Unit quaternion x, y, z, w.
    angle : ndarray (3,)
        Along the axis, rad; not zero.

    Returns
    -------
    ndarray (4,)
        Unit quaternion x, y, z, w.
    """
    size = float(np.linalg.norm(angle))
    v, w = np.sin(size / 2) * angle / size, np.cos(size / 2)
    vector = orientation[3] * v + w * orientation[:3] + np.cross(orientation[:3], v)
    return np.array([*vector, orientation[3] * w - orientation[:3] @ v])
