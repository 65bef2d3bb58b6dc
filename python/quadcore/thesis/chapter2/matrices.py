"""Matrices of the equation of motion (2.20)-(2.42), with one function for each.

All matrices are 6 x 6, except for K_zeta (6 x n) and the vector g. Rows and columns are x, y, z (m,
N) and phi, theta, psi (rad, N m). `v` is a `Vehicle`, `q` is [xi, eta], and `omega` contains the
signed rotor speeds in rad/s.
"""

from __future__ import annotations

import numpy as np

from .kinematics import euler_rates_to_body, generalise, gradient_of_W, skew
from .vehicle import Vehicle


def J(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return J = W^T I_B W (2.16), 3 x 3: the inertia for the Euler angle rates, kg m^2."""
    W = euler_rates_to_body(q[3:])
    inertia: np.ndarray = W.T @ v.inertia @ W
    return inertia


def gradient_of_J(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return dJ/dphi, dJ/dtheta and dJ/dpsi, shape (3, 3, 3); the first index is the angle."""
    half = euler_rates_to_body(q[3:]).T @ v.inertia @ gradient_of_W(q[3:])
    gradient: np.ndarray = half + half.transpose(0, 2, 1)
    return gradient


def B(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return the inertia matrix (2.20)."""
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = v.mass * np.eye(3)
    inertia[3:, 3:] = J(v, q)
    return inertia


def C(v: Vehicle, q: np.ndarray, qdot: np.ndarray) -> np.ndarray:
    """Return the centrifugal and Coriolis matrix (2.20), from the Christoffel symbols of J:

        C_ij = 1/2 sum_k (dJ_ij/deta_k + dJ_ik/deta_j - dJ_jk/deta_i) etadot_k

    With this matrix, Jdot - 2 C is skew-symmetric. The matrix Jdot - 1/2 d(etadot^T J)/deta of
    (2.20) gives the same product with etadot, but lacks this property. The entries printed in
    (2.21) have neither property because of two errors: C_21 contains - instead of + I_x psidot
    c(theta), and I_z - I_y in C_32 lacks the factor phidot s(phi)^2 c(theta). With these
    corrections they have both properties, although the entries differ from those here.
    """  # noqa: D400
    dJ, etadot = gradient_of_J(v, q), qdot[3:]
    along = np.einsum("kij,k->ij", dJ, etadot)  # Jdot
    across = np.einsum("jik,k->ij", dJ, etadot)
    coriolis = np.zeros((6, 6))
    coriolis[3:, 3:] = 0.5 * (along + across - across.T)
    return coriolis


def g(v: Vehicle) -> np.ndarray:
    """Return the gravity vector (2.20), N; the printed vector lacks its sixth entry."""
    return np.concatenate([-v.mass * v.gravity, np.zeros(3)])


def G_a(v: Vehicle, q: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Return the gyroscopic matrix (2.22)-(2.24): S(nu) sum I_R omega_i e_3 on the left side.

    The matrix is skew-symmetric, so it does no work. The printed matrix lacks W^T. The angular
    momentum of a slowed rotor is smaller by the factor sim_slow.
    """
    T = generalise(q[3:])
    h = (v.rotor_inertia * omega / v.slow) @ v.axes
    body = np.zeros((6, 6))
    body[3:, 3:] = -skew(h)
    matrix: np.ndarray = T @ body @ T.T
    return matrix


def F_flap(v: Vehicle, q: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Return the blade flapping matrix (2.25)-(2.27) of all rotors.

    The force is D = T/|omega| (A_flap V_p + B_flap nu) with T/|omega| = k |omega|. Mirror symmetry
    requires the sign s of the rotor's spin in A_1s and B_2, which the printed equations lack. The
    printed B_flap also depends on the direction in the rotor disc. With S = S(axis), which rotates
    vectors in the disc by 90 degrees,

        A_flap = -(A_1c 1 + s A_1s S)/r,   B_flap = -(s B_2 1 + B_1 S).
    """
    if not v.flaps:
        return np.zeros((6, 6))
    s = np.where(omega < 0, -1, 1)[:, None, None]
    quarter_turns = np.array([skew(axis) for axis in v.axes])
    A_flap = -(v.A_1c * v.discs + s * v.A_1s * quarter_turns) / v.r
    B_flap = -(s * v.B_2 * v.discs + v.B_1 * quarter_turns)
    of_rates = np.broadcast_to(np.eye(6)[3:], (len(omega), 3, 6))
    force = A_flap @ v.levers.transpose(0, 2, 1) + B_flap @ of_rates
    wrench = np.einsum("i,iaj,ijb->ab", v.k * np.abs(omega), v.levers, force)
    T = generalise(q[3:])
    matrix: np.ndarray = -T @ wrench @ T.T
    return matrix


def F_I(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return the induced drag matrix (2.28) of all rotors."""
    return v.K_I * _disc_drag(v, q)


def F_T(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return the translational drag matrix (2.29) of all rotors; first branch as in the thesis."""
    return v.K_T * _disc_drag(v, q)


def F_P(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return the profile drag matrix (2.30) of all rotors."""
    return v.K_P * _disc_drag(v, q)


def F_par(v: Vehicle, qdot: np.ndarray) -> np.ndarray:
    """Return the parasitic drag matrix (2.31) at the centre of mass; |V| is equal in all axes."""
    return np.diag([v.K_par * float(np.linalg.norm(qdot[:3]))] * 3 + [0.0] * 3)


def K_zeta(v: Vehicle, q: np.ndarray, spin: np.ndarray) -> np.ndarray:
    """Return K_zeta (2.40)-(2.42), the forces per squared speed; `spin` contains the speed signs.

    The thrust k (2.10) acts along the axis of the rotor, and the reaction torque b (2.11) about it.
    The printed reaction of rotor 1 contains the sign of its spin; here `Vehicle.b` contains the
    sign.
    """
    wrench = v.thrust_wrenches.copy()
    wrench[3:] += v.b * spin * v.axes.T
    matrix: np.ndarray = generalise(q[3:]) @ wrench
    return matrix


def _disc_drag(v: Vehicle, q: np.ndarray) -> np.ndarray:
    """Return the drag matrix for a unit coefficient; it is symmetric and dissipates power."""
    T = generalise(q[3:])
    matrix: np.ndarray = T @ v.disc_drag @ T.T
    return matrix
