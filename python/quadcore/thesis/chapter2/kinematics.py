"""Position, Euler angles and their rates: equations (2.3)-(2.9)."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np


def rotation(eta: np.ndarray) -> np.ndarray:
    """Return R_321 (2.8), body to world: Rz(psi) Ry(theta) Rx(phi).

    The thesis swaps the axis labels of (2.5) and (2.7), and prints the entry (2,1) as c(theta)
    c(psi).
    """
    (sphi, stheta, spsi), (cphi, ctheta, cpsi) = np.sin(eta).tolist(), np.cos(eta).tolist()
    return np.array(
        [
            [ctheta * cpsi, sphi * stheta * cpsi - cphi * spsi, cphi * stheta * cpsi + sphi * spsi],
            [ctheta * spsi, sphi * stheta * spsi + cphi * cpsi, cphi * stheta * spsi - sphi * cpsi],
            [-stheta, sphi * ctheta, cphi * ctheta],
        ]
    )


def quaternion(eta: np.ndarray) -> np.ndarray:
    """Return the orientation of the body in the world as a unit quaternion x, y, z, w."""
    (sphi, stheta, spsi), (cphi, ctheta, cpsi) = np.sin(eta / 2).tolist(), np.cos(eta / 2).tolist()
    return np.array(
        [
            sphi * ctheta * cpsi - cphi * stheta * spsi,
            cphi * stheta * cpsi + sphi * ctheta * spsi,
            cphi * ctheta * spsi - sphi * stheta * cpsi,
            cphi * ctheta * cpsi + sphi * stheta * spsi,
        ]
    )


def euler_rates_to_body(eta: np.ndarray) -> np.ndarray:
    """Return W (2.9): nu = [p, q, r] = W(eta) etadot, the angular velocity in body axes."""
    return _euler_rates_to_body(*eta.tolist())


@lru_cache(maxsize=1)  # all matrices at one instant use the same result
def _euler_rates_to_body(phi: float, theta: float, _: float) -> np.ndarray:
    sphi, cphi, stheta, ctheta = math.sin(phi), math.cos(phi), math.sin(theta), math.cos(theta)
    W = np.array([[1, 0, -stheta], [0, cphi, ctheta * sphi], [0, -sphi, cphi * ctheta]])
    W.flags.writeable = False
    return W


def gradient_of_W(eta: np.ndarray) -> np.ndarray:
    """Return dW/dphi, dW/dtheta and dW/dpsi, shape (3, 3, 3); the first index is the angle."""
    (sphi, stheta, _), (cphi, ctheta, _) = np.sin(eta).tolist(), np.cos(eta).tolist()
    by_phi = [[0, 0, 0], [0, -sphi, ctheta * cphi], [0, -cphi, -sphi * ctheta]]
    by_theta = [[0, 0, -ctheta], [0, 0, -stheta * sphi], [0, 0, -cphi * stheta]]
    return np.array([by_phi, by_theta, np.zeros((3, 3))])


def skew(a: np.ndarray) -> np.ndarray:
    """Return S(a) of (2.22): S(a) b = a x b."""
    x, y, z = a.tolist()
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def generalise(eta: np.ndarray) -> np.ndarray:
    """Return the 6 x 6 matrix T(q), which converts body force and torque to generalised forces.

        [f; tau] = T(q) [f_B; tau_B],   T = [[R, 0], [0, W^T]],   [V_B; nu] = T^T qdot

    The thesis uses body torques as generalised torques: (2.19), (2.24), (2.36) and (2.42) contain
    the identity instead of W^T. W^T follows from virtual work: tau_B . nu = tau_B . W etadot.
    """
    return _generalise(*eta.tolist())


@lru_cache(maxsize=1)  # all matrices at one instant use the same result
def _generalise(phi: float, theta: float, psi: float) -> np.ndarray:
    eta = np.array([phi, theta, psi])
    T = np.zeros((6, 6))
    T[:3, :3] = rotation(eta)
    T[3:, 3:] = euler_rates_to_body(eta).T
    T.flags.writeable = False
    return T
