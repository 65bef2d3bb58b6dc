"""The matrices of chapter 2's mathematical model, by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from vehicles import AIR, COM, DRAG, FLAPPING, GRAVITY, MOTOR, ODD, SKEW, WIND, Hangar, vehicle

from quadcore.thesis.chapter2 import MathematicalModel, Vehicle, matrices
from quadcore.thesis.chapter2.kinematics import (
    euler_rates_to_body,
    generalise,
    gradient_of_W,
    rotation,
)


@pytest.fixture(scope="module")
def odd(tmp_path_factory):
    """A vehicle without symmetry, in wind, with every force there is."""
    air = {**AIR, **DRAG, **FLAPPING, "reactionTorque": "opposing", "sim_slow": 2}
    urdf = vehicle(ODD, 1, SKEW, COM, air, {**MOTOR, "sim_slow": 2})
    return Vehicle.of(Hangar(tmp_path_factory.mktemp("odd"))(urdf, GRAVITY, WIND))


def states(count, seed=2):
    """Random q, qdot, omega, the pitch short of 80 degrees."""
    random = np.random.RandomState(seed)
    for _ in range(count):
        q = random.uniform(-1, 1, 6) * [9, 9, 9, np.pi, 1.4, np.pi]
        yield q, random.normal(size=6) * [5, 5, 5, 3, 3, 3], random.normal(size=4) * 400


def test_the_rotation_is_yaw_pitch_roll_and_W_its_rate():
    for q, qdot, _ in states(100):
        eta, etadot = q[3:], qdot[3:]
        R = rotation(eta)
        assert np.allclose(R, Rotation.from_euler("ZYX", eta[::-1]).as_matrix(), atol=1e-14)
        spin = R.T @ (rotation(eta + 1e-6 * etadot) - rotation(eta - 1e-6 * etadot)) / 2e-6
        nu = euler_rates_to_body(eta) @ etadot
        assert np.allclose([spin[2, 1], spin[0, 2], spin[1, 0]], nu, atol=1e-8)


def test_gradients_are_those_of_differences(odd):
    for q, _, _ in states(20):
        for k, (of_W, of_J) in enumerate(zip(gradient_of_W(q[3:]), matrices.gradient_of_J(odd, q))):
            step = 1e-6 * np.eye(6)[3 + k]
            slope = euler_rates_to_body((q + step)[3:]) - euler_rates_to_body((q - step)[3:])
            assert np.allclose(slope / 2e-6, of_W, atol=1e-9)
            slope = matrices.J(odd, q + step) - matrices.J(odd, q - step)
            assert np.allclose(slope / 2e-6, of_J, atol=1e-9)


def test_Jdot_minus_2C_is_skew_symmetric(odd):
    for q, qdot, _ in states(10_000):
        Jdot = np.einsum("kij,k->ij", matrices.gradient_of_J(odd, q), qdot[3:])
        C = matrices.C(odd, q, qdot)[3:, 3:]
        rest = Jdot - 2 * C
        assert np.abs(rest + rest.T).max() < 1e-15 * (1 + np.abs(C).max() / 1e-2)


def as_printed(inertia, eta, etadot, repaired):
    """(2.21), for a diagonal inertia; repaired by a sign of C_21 and a term of C_32."""
    Ix, Iy, Iz = inertia
    (Sphi, Stheta, _), (Cphi, Ctheta, _) = np.sin(eta), np.cos(eta)
    phi, theta, psi = etadot
    sign, term = (1, phi * Sphi**2 * Ctheta) if repaired else (-1, 0)
    C12 = (Iy - Iz) * (theta * Cphi * Sphi + psi * Sphi**2 * Ctheta)
    C12 += (Iz - Iy) * psi * Cphi**2 * Ctheta
    C13 = (Iz - Iy) * psi * Cphi * Sphi * Ctheta**2
    C23 = (-Ix + Iy * Sphi**2 + Iz * Cphi**2) * psi * Stheta * Ctheta
    C32 = (Iz - Iy) * (theta * Cphi * Sphi * Stheta + term) + (Iy - Iz) * phi * Cphi**2 * Ctheta
    C33 = (Iy - Iz) * phi * Cphi * Sphi * Ctheta**2
    C33 += (Ix - Iy * Sphi**2 - Iz * Cphi**2) * theta * Stheta * Ctheta
    return np.array(
        [
            [0, C12 - Ix * psi * Ctheta, C13],
            [-C12 + sign * Ix * psi * Ctheta, (Iz - Iy) * phi * Cphi * Sphi, C23],
            [-C13 - Ix * theta * Ctheta, C32 - C23, C33],
        ]
    )


def test_the_printed_C_is_a_right_one_but_for_a_sign_and_a_term(odd):
    """It has other entries than that of the Christoffel symbols, but the same effect."""
    v = replace(odd, inertia=np.diag([0.007, 0.009, 0.0135]))
    worst = {True: np.zeros(2), False: np.zeros(2)}
    for q, qdot, _ in states(1000):
        eta, etadot = q[3:], qdot[3:]
        C = matrices.C(v, q, qdot)[3:, 3:]
        Jdot = np.einsum("kij,k->ij", matrices.gradient_of_J(v, q), etadot)
        for repaired, errors in worst.items():
            printed = as_printed(np.diag(v.inertia), eta, etadot, repaired)
            rest = Jdot - 2 * printed
            found = np.abs((printed - C) @ etadot).max(), np.abs(rest + rest.T).max()
            np.maximum(errors, found, out=errors)
        assert np.abs(as_printed(np.diag(v.inertia), eta, etadot, True) - C).max() > 1e-6
    assert (worst[True] < 1e-14).all()
    assert (worst[False] > 0.1).all()


def test_the_form_of_2_20_has_the_right_effect_but_is_not_skew_symmetric(odd):
    for q, qdot, _ in states(100):
        etadot = qdot[3:]
        gradient = matrices.gradient_of_J(odd, q)
        Jdot = np.einsum("kij,k->ij", gradient, etadot)
        C = Jdot - np.einsum("kij,i->kj", gradient, etadot) / 2
        assert np.allclose(C @ etadot, matrices.C(odd, q, qdot)[3:, 3:] @ etadot, atol=1e-14)
        rest = Jdot - 2 * C
        assert np.abs(rest + rest.T).max() > 1e-5


def by_newton_and_euler(v, q, qdot, omega):
    """Accelerations of the centre of mass and of the frame's rate, from forces in body axes."""
    R = rotation(q[3:])
    nu = euler_rates_to_body(q[3:]) @ qdot[3:]
    air = R.T @ (qdot[:3] - v.wind)
    w, s = omega[:, None], np.sign(omega)[:, None]
    speed = air + np.cross(nu, v.arms)
    plane = speed - np.sum(speed * v.axes, axis=1)[:, None] * v.axes
    turning = nu - (v.axes @ nu)[:, None] * v.axes
    sideways = -v.A_1c * plane - s * v.A_1s * np.cross(v.axes, plane)
    rolling = -s * v.B_2 * turning - v.B_1 * np.cross(v.axes, turning)
    forces = v.k * w**2 * v.axes - (v.K_I + v.K_T + v.K_P) * plane
    forces = forces + v.k * s * w * (sideways / v.r + rolling)
    weight_and_hull = R.T @ (v.mass * v.gravity) - v.K_par * np.linalg.norm(air) * air
    momentum = v.inertia @ nu + (v.rotor_inertia * omega / v.slow) @ v.axes
    torques = np.cross(v.arms, forces) + v.b * s * w**2 * v.axes
    force = forces.sum(axis=0) + weight_and_hull
    torque = torques.sum(axis=0) - np.cross(nu, momentum)
    return R @ force / v.mass, np.linalg.solve(v.inertia, torque)


def test_lagrange_and_newton_and_euler_agree(odd):
    model = MathematicalModel(odd)
    for q, qdot, omega in states(1000):
        qddot = model.acceleration(q, qdot, omega, np.zeros(4))
        linear, angular = by_newton_and_euler(odd, q, qdot, omega)
        Wdot = np.einsum("kij,k->ij", gradient_of_W(q[3:]), qdot[3:])
        nudot = euler_rates_to_body(q[3:]) @ qddot[3:] + Wdot @ qdot[3:]
        scale = 1 + np.abs(qddot).max()
        assert np.abs(qddot[:3] - linear).max() < 1e-10
        assert np.abs(nudot - angular).max() < 1e-10 * scale


def test_the_gyroscopic_effect_takes_no_power(odd):
    for q, qdot, omega in states(1000):
        G_a = matrices.G_a(odd, q, omega)
        assert np.abs(G_a + G_a.T).max() < 1e-16
        w = euler_rates_to_body(q[3:]) @ qdot[3:]
        H = (odd.rotor_inertia * omega / odd.slow) @ odd.axes
        power = qdot @ G_a @ qdot
        assert abs(power) < 2e-15 * np.linalg.norm(w) ** 2 * np.linalg.norm(H) / np.cos(q[4])


def generalised(v, q, at_rotors, at_center=(0, 0, 0)):
    """Generalised force of forces in body axes, by virtual work."""
    torque = np.cross(v.arms, at_rotors).sum(axis=0)
    return np.append(
        rotation(q[3:]) @ (np.sum(at_rotors, axis=0) + at_center),
        euler_rates_to_body(q[3:]).T @ torque,
    )


@pytest.mark.parametrize("name", ["K_I", "K_T", "K_P"])
def test_rotor_drag_is_the_force_against_each_rotors_velocity_in_its_plane(odd, name):
    F = getattr(matrices, f"F_{name[-1]}")
    for q, qdot, _ in states(300):
        v_B = rotation(q[3:]).T @ qdot[:3]
        nu = euler_rates_to_body(q[3:]) @ qdot[3:]
        speeds = v_B + np.cross(nu, odd.arms)
        planes = speeds - np.sum(speeds * odd.axes, axis=1)[:, None] * odd.axes
        expected = generalised(odd, q, -getattr(odd, name) * planes)
        assert np.allclose(-F(odd, q) @ qdot, expected, rtol=1e-12, atol=1e-14)
        assert qdot @ F(odd, q) @ qdot >= 0


def test_parasitic_drag_is_the_force_against_the_velocity(odd):
    for q, qdot, _ in states(300):
        v_B = rotation(q[3:]).T @ qdot[:3]
        expected = generalised(odd, q, np.zeros((4, 3)), -0.003 * np.linalg.norm(v_B) * v_B)
        assert np.allclose(-matrices.F_par(odd, qdot) @ qdot, expected, rtol=1e-12, atol=1e-15)


def test_flapping_is_the_force_of_printed_matrices_with_their_signs(thesis):
    """(2.26) and (2.27) as THESIS' axes have them: rotors along z."""
    v = replace(thesis, A_1c=0.1, A_1s=0.03, B_1=0.004, B_2=0.003)
    for q, qdot, omega in states(300):
        v_B = rotation(q[3:]).T @ qdot[:3]
        nu = euler_rates_to_body(q[3:]) @ qdot[3:]
        forces = []
        for arm, w in zip(v.arms, omega):
            s = np.sign(w)
            A = np.array([[-0.1, s * 0.03, 0], [-s * 0.03, -0.1, 0], [0, 0, 0]]) / v.r
            B = np.array([[-s * 0.003, 0.004, 0], [-0.004, -s * 0.003, 0], [0, 0, 0]])
            forces.append(v.k * abs(w) * (A @ (v_B + np.cross(nu, arm)) + B @ nu))
        expected = generalised(v, q, forces)
        found = -matrices.F_flap(v, q, omega) @ qdot
        assert np.allclose(found, expected, rtol=1e-11, atol=1e-13)


def test_K_zeta_is_2_51_at_level_attitude(thesis):
    k, b, l = 1.1487e-5, 2.69e-7, 0.2  # noqa: E741
    rows = np.array([[k] * 4, [0, -k * l, 0, k * l], [-k * l, 0, k * l, 0], [b, -b, b, -b]])
    K_zeta = matrices.K_zeta(thesis, np.zeros(6), np.array([1, -1, 1, -1]))
    assert np.allclose(K_zeta[2:], rows, rtol=1e-12, atol=1e-20)
    assert np.abs(K_zeta[:2]).max() < 1e-20


def test_body_torques_become_generalised_by_virtual_work(thesis):
    """tau_B . nu = tau . etadot: (2.19) and (2.42) as printed, without W^T, break it."""
    for q, qdot, omega in states(100):
        spin = np.sign(omega)
        level = matrices.K_zeta(thesis, np.zeros(6), spin) @ omega**2
        zeta = matrices.K_zeta(thesis, q, spin) @ omega**2
        twist = generalise(q[3:]).T @ qdot
        assert zeta @ qdot == pytest.approx(level @ twist, rel=1e-12, abs=1e-12)
