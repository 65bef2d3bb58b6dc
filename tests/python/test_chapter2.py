"""The mathematical model of chapter 2: its matrices by hand, and its flights by engine eigen."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from vehicles import AIR, CROSS, DRAG, FLAPPING, MOTOR, ODD, SKEW, Hangar, start, vehicle

import quadcore as qc
from quadcore.chapter2 import GYROSTAT, THESIS, MathematicalModel, Terms, Vehicle, matrices
from quadcore.chapter2.kinematics import (
    euler_rates_to_body,
    generalise,
    gradient_of_W,
    rotation,
)
from quadcore.validation.given_speeds import STIFFNESS, fly_given_speeds

GRAVITY = (0, 0, -9.8)
COM = (0.004, -0.003, 0.005)
WIND = np.array([2.0, -1.0, 0.5])
HOVER = np.sqrt(1.04 * 9.8 / 4 / 1.1487e-5)
BALANCED = HOVER * np.array([1, -1, 1, -1])
FLIGHT = np.column_stack(
    [
        [0, 0.5, 1, 1.2, 1.4, 3, 3.4, 3.8, 6, 6.2, 6.4],
        BALANCED
        * [
            [1, 1, 1, 1],
            [1.01, 1.01, 1.01, 1.01],
            [1.008, 1.01, 1.012, 1.01],
            [1.012, 1.01, 1.008, 1.01],
            [1.01, 1.01, 1.01, 1.01],
            [1.04, 0.98, 1.04, 0.98],
            [0.98, 1.04, 0.98, 1.04],
            [1.01, 1.01, 1.01, 1.01],
            [1.01, 1.008, 1.01, 1.012],
            [1.01, 1.012, 1.01, 1.008],
            [1.01, 1.01, 1.01, 1.01],
        ],
    ]
)


@pytest.fixture(scope="module")
def odd(tmp_path_factory):
    """A vehicle without symmetry, in wind, with every force there is."""
    air = {**AIR, **DRAG, **FLAPPING, "reactionTorque": "opposing", "sim_slow": 2}
    urdf = vehicle(ODD, 1, SKEW, COM, air, {**MOTOR, "sim_slow": 2})
    return Vehicle.of(Hangar(tmp_path_factory.mktemp("odd"))(urdf, GRAVITY, WIND))


@pytest.fixture(scope="module")
def thesis():
    return Vehicle.of(qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1}))


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
    for q, qdot, omega in states(10_000):
        qddot = model.acceleration(q, qdot, omega, np.zeros(4))
        linear, angular = by_newton_and_euler(odd, q, qdot, omega)
        Wdot = np.einsum("kij,k->ij", gradient_of_W(q[3:]), qdot[3:])
        nudot = euler_rates_to_body(q[3:]) @ qddot[3:] + Wdot @ qdot[3:]
        scale = 1 + np.abs(qddot).max()
        assert np.abs(qddot[:3] - linear).max() < 1e-10
        assert np.abs(nudot - angular).max() < 1e-10 * scale


def test_the_gyroscopic_effect_takes_no_power(odd):
    for q, qdot, omega in states(10_000):
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


def quadrotor(engine="eigen", dt=None, drag="all", **tags):
    """The shipped quadrotor, at rest with its rotors at hover speed; chapter 2 by default."""
    parameters = {"drone_plugin.dragModel": "chapter2"}
    for name in ("induced", "translational", "profile", "parasitic"):
        if drag not in ("all", name):
            parameters[f"drone_plugin.{name}DragCoeff"] = 0
    if drag in ("all", "flapping"):
        parameters.update((f"drone_plugin.{tag}", value) for tag, value in FLAPPING.items())
    parameters.update((tag.replace("__", "."), value) for tag, value in tags.items())
    simulation = qc.Simulation(
        "quadrotor", engine, dt=dt, parameters=parameters, xacro_args={"sim_slow": 1}
    )
    return start(simulation, rotor_velocity=BALANCED)


@lru_cache(maxsize=None)
def by_engine(drag="all"):
    return quadrotor(drag=drag).run(10, FLIGHT, 10)


@lru_cache(maxsize=None)
def by_model(terms, drag="all"):
    simulation = quadrotor(drag=drag)
    model = MathematicalModel(Vehicle.of(simulation), terms)
    return model.fly(10, FLIGHT, simulation.state.copy(), 1e-2)


def distance(log, model):
    """Largest difference of positions (m) and body rates (rad/s)."""
    apart = np.abs(log.position - model.position).max()
    return max(apart, np.abs(log.angular_velocity - model.angular_velocity).max())


@pytest.mark.parametrize(
    "drag", ["none", "induced", "translational", "profile", "parasitic", "flapping", "all"]
)
def test_with_nothing_left_out_the_model_flies_as_eigen(drag):
    log, model = by_engine(drag), by_model(GYROSTAT, drag)
    assert np.ptp(log.position, axis=0).min() > 0.5
    assert distance(log, model) < 1e-8
    assert np.abs(log.linear_velocity - model.linear_velocity).max() < 1e-8
    assert np.abs(np.abs((log.orientation * model.orientation).sum(axis=1)) - 1).max() < 1e-14
    assert np.abs(log.rotor_velocity - model.rotor_velocity).max() < 1e-6


@pytest.mark.parametrize("slow", [1, 8])
@pytest.mark.parametrize("reaction", ["thesis", "opposing"])
def test_so_it_does_any_vehicle_in_wind(hangar, slow, reaction):
    air = {**AIR, **DRAG, **FLAPPING, "dragModel": "chapter2", "reactionTorque": reaction}
    urdf = vehicle(ODD, 1, SKEW, COM, {**air, "sim_slow": slow}, {**MOTOR, "sim_slow": slow})
    simulation = hangar(urdf, GRAVITY, WIND, engine="eigen", dt=5e-4)
    start(simulation, rotor_velocity=BALANCED / slow, linear_velocity=[1, 2, 3])
    state = simulation.state.copy()
    commands = FLIGHT * [0.1, 1, 1, 1, 1]
    log = simulation.run(0.6, commands, 20)
    model = MathematicalModel(Vehicle.of(simulation), GYROSTAT).fly(0.6, commands, state, 1e-2)
    assert np.abs(log.angular_velocity).max() > 1
    assert distance(log, model) < 1e-8


@pytest.mark.parametrize("drag", ["induced", "translational", "profile"])
def test_rotor_drag_of_the_appendix_is_that_of_chapter_2(drag):
    logs = [
        quadrotor(drag=drag, drone_plugin__dragModel=model).run(3, FLIGHT)
        for model in ("appendix", "chapter2")
    ]
    assert distance(*logs) < 1e-11


# What the equations of chapter 2 leave out of a gyrostat, and how far that takes a flight (m).
LEFT_OUT = {"spin_up": 1e-1, "dragged_rotors": 1e-3}


@pytest.mark.parametrize("term", LEFT_OUT)
def test_a_term_that_the_thesis_leaves_out_opens_a_gap_that_it_closes(term):
    without = by_model(GYROSTAT._replace(**{term: False}))
    assert np.abs(by_engine().position - without.position).max() > LEFT_OUT[term]
    assert distance(by_engine(), by_model(GYROSTAT)) < 1e-8


@pytest.mark.parametrize("lag", [True, False], ids=["lagging motors", "ideal motors"])
def test_eigen_with_given_speeds_leaves_out_what_the_thesis_does(lag):
    """The other direction: the engine comes to the model of the thesis as its motors stiffen."""
    expected = by_model(THESIS if lag else Terms(motor_lag=False)).position
    assert np.abs(by_engine().position - expected).max() > 0.1
    vehicle_, paths = Vehicle.of(quadrotor()), []
    for dt in (1e-3, 5e-4):
        kp = STIFFNESS * vehicle_.rotor_inertia.min() / dt
        stiff = quadrotor(dt=dt, motorpid_plugin__kp=kp)
        every = round(1e-2 / dt)
        paths.append(fly_given_speeds(stiff, vehicle_, FLIGHT, 10, every, lag).position)
    gaps = [np.abs(path - expected).max() for path in paths]
    assert gaps[0] < 1e-3
    assert gaps[1] == pytest.approx(gaps[0] / 2, rel=0.05)
    assert np.abs(2 * paths[1] - paths[0] - expected).max() < 1e-5


def test_light_rotors_make_the_spin_up_vanish(hangar):
    """The same by an edit of the model: inertia of the rotors to nothing, their pace kept."""
    rotors = [rotor._replace(inertia=np.array(rotor.inertia) * 1e-6) for rotor in CROSS]
    air = {**AIR, **DRAG, "dragModel": "chapter2"}
    urdf = vehicle(rotors, air=air, motor={"kp": MOTOR["kp"] * 1e-6})
    simulation = start(hangar(urdf, GRAVITY, engine="eigen"), rotor_velocity=BALANCED)
    model = MathematicalModel(Vehicle.of(simulation), Terms(dragged_rotors=True))
    expected = model.fly(10, FLIGHT, simulation.state.copy(), 1e-2)
    assert distance(simulation.run(10, FLIGHT, 10), expected) < 1e-6


def test_a_pitch_of_90_degrees_ends_the_flight(thesis):
    simulation = quadrotor()
    start(simulation, angular_velocity=[0, 1.0, 0])
    model = MathematicalModel(replace(thesis, K_par=0.0, K_I=0.0, K_T=0.0, K_P=0.0))
    with pytest.raises(qc.FlightError, match="the pitch reaches 90 degrees") as ended:
        model.fly(10, [[0, *BALANCED]], simulation.state.copy())
    assert ended.value.time == pytest.approx(np.pi / 2, abs=0.02)
    lying = start(simulation, orientation=[0, np.sqrt(0.5), 0, np.sqrt(0.5)])
    with pytest.raises(qc.FlightError, match="the pitch reaches 90 degrees"):
        model.fly(1, [[0, *BALANCED]], lying.state.copy())


def test_terms_of_changing_speeds_need_motors_that_lag(thesis):
    with pytest.raises(ValueError, match="need motor_lag"):
        MathematicalModel(thesis, Terms(motor_lag=False, spin_up=True))


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ({"motorpid_plugin.kd": 1e-9}, "proportional motors"),
        ({"motorpid_plugin.ki": 1, "motorpid_plugin.iMax": 1}, "proportional motors"),
        ({"motorpid_plugin.commandTimeout": 1}, "no <commandTimeout>"),
        ({"motorpid_plugin.rotorJoints": ["rotor1", "rotor2"]}, "every rotor"),
        ({"drone_plugin.rotorJoints": ["rotor1", "rotor2"]}, "every rotor"),
    ],
)
def test_a_vehicle_beyond_chapter_2_is_refused(tags, says):
    with pytest.raises(qc.InputError, match=says):
        Vehicle.of(qc.Simulation("quadrotor", parameters=tags))


def test_a_vehicle_without_air_is_refused(hangar):
    with pytest.raises(qc.InputError, match=r"needs one plugin libaerodynamic_plugin\.so; got 0"):
        Vehicle.of(hangar(vehicle(motor=MOTOR)))


def test_rotors_stand_in_the_order_of_the_command():
    order = ["rotor3", "rotor1", "rotor4", "rotor2"]
    tags = {"motorpid_plugin.rotorJoints": order}
    turned = Vehicle.of(qc.Simulation("quadrotor", parameters=tags))
    plain = Vehicle.of(qc.Simulation("quadrotor"))
    assert np.array_equal(turned.arms, plain.arms[[2, 0, 3, 1]])
