"""The shipped vehicles, and the arguments of the quadrotor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from flights import ENGINES, HOVER
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.control import references

ROOT = Path(__file__).resolve().parents[2]
SIZES = {"quadrotor": 1.0, "hexarotor": 1.0, "crazyflie": 0.25}
CONTROLLERS = ("geometric", "indi", "lqr")


def max_error(simulation, reference, controller, duration, since=0.0):
    simulation.set_state(references.start(simulation, reference))
    log = simulation.run(duration, controller=controller, reference=reference, log_every=10)
    wanted = np.array([reference(t).position for t in log.time])
    return np.linalg.norm(log.position - wanted, axis=1)[log.time > since].max()


def scaled(size):
    """Hover, spiral and circle, of a size."""
    return [
        references.hover(),
        references.spiral(radius=2 * size, climb=size),
        references.circle(radius=2 * size),
    ]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("model", ["hexarotor", "crazyflie"])
def test_shipped_vehicles_fly_with_their_gains(model, engine):
    for reference in scaled(SIZES[model]):
        simulation = qc.Simulation(model, engine=engine)
        assert max_error(simulation, reference, "geometric", 8, since=5) < 0.05, reference


@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize("model", SIZES)
def test_shipped_vehicles_fly_every_reference(model, controller):
    size = SIZES[model]
    rows = references.waypoints(ROOT / "config" / "waypoints.yaml").rows * [1, size, size, size]
    moving = [
        *scaled(size),
        references.eight(length=2 * size, width=size),
        references.waypoints(rows),
        references.series(rows[1:-1] - [rows[1, 0], 0, 0, 0]),
    ]
    for reference in moving:
        simulation = qc.Simulation(model, engine="eigen")
        assert max_error(simulation, reference, controller, 4) < 0.05, reference
    for reference in (references.step(dx=size), references.ramp(vx=size)):
        simulation = qc.Simulation(model, engine="eigen")
        assert max_error(simulation, reference, controller, 10, since=8) < 0.05, reference


def test_the_crazyflie_is_as_it_was_measured():
    simulation = qc.Simulation("crazyflie", engine="eigen")
    assert simulation.mass == pytest.approx(0.027)
    measured = [
        [16.571710e-6, 0.830806e-6, 0.718277e-6],
        [0.830806e-6, 16.655602e-6, 1.800197e-6],
        [0.718277e-6, 1.800197e-6, 29.261652e-6],
    ]
    assert simulation.inertia == pytest.approx(np.array(measured), rel=1e-9)
    # A quarter of the weight at the speed of the command 36345, by the measured lines.
    command = 36345
    thrust = 2.130295e-11 * command**2 + 1.032633e-6 * command + 5.484560e-4
    speed = 0.04076521 * command + 380.8359
    state = simulation.state.copy()
    state.rotor_velocity = speed * np.array([1.0, -1, 1, -1])
    simulation.set_state(state)
    log = simulation.run(0.001, wrenches=True)
    assert log.wrenches["thrust"][0, 2] == pytest.approx(4 * thrust, rel=1e-4)
    assert 4 * thrust == pytest.approx(0.027 * 9.81, rel=1e-4)
    # A motor is 63 % of the way to another speed after 1/15.4666 s.
    simulation.command(1.1 * state.rotor_velocity)
    before = simulation.state.rotor_velocity[0]
    simulation.step(65)
    way = (simulation.state.rotor_velocity[0] - before) / (1.1 * speed - before)
    assert way == pytest.approx(1 - np.exp(-0.065 * 15.4666), abs=0.01)


@pytest.fixture
def lined_up():
    def make(**arguments):
        return qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1, **arguments})

    return make


def test_masses_and_moments_follow_the_arguments(lined_up):
    plain = lined_up()
    assert plain.mass == pytest.approx(1.04)
    assert lined_up(frame_mass=1.5).model.links[0].inertia == pytest.approx(
        1.5 * plain.model.links[0].inertia
    )
    heavy = lined_up(propeller_mass=0.02)
    assert heavy.model.links[1].mass == 0.02
    assert heavy.model.links[1].inertia == pytest.approx(2 * plain.model.links[1].inertia)
    armed = lined_up(arm_mass=0.05)
    assert armed.mass == pytest.approx(1.24)
    # Rods of 0.1 m around 0.15 m.
    pair = 2 * 0.05 * (0.01 / 12 + 0.0225)
    added = armed.model.links[0].inertia - plain.model.links[0].inertia
    assert added == pytest.approx(np.diag([pair, pair, 2 * pair]))
    long = lined_up(arm_length=0.15)
    assert [np.hypot(*joint.xyz[:2]) for joint in long.model.joints] == pytest.approx([0.25] * 4)


@pytest.mark.parametrize(
    ("drag", "acting"),
    [
        ("all", {"induced", "translational", "profile", "parasitic"}),
        ("none", set()),
        ("profile", {"profile"}),
    ],
)
def test_the_drags_that_are_named_act(drag, acting, lined_up):
    simulation = lined_up(drag=drag)
    state = simulation.state.copy()
    state.linear_velocity, state.rotor_velocity = [1, 2, 0.5], HOVER.astype(float)
    simulation.set_state(state)
    wrenches = simulation.run(0.001, wrenches=True).wrenches
    names = ("induced", "translational", "profile", "parasitic")
    assert {name for name in names if np.abs(wrenches[name][0]).max() > 0} == acting


def test_a_drag_of_another_name_is_refused(lined_up):
    with pytest.raises(qc.InputError, match=r"quadrotor\.urdf\.xacro:.*inducd"):
        lined_up(drag="inducd")


def test_the_noise_of_the_odometry_follows_the_arguments(lined_up):
    noisy = lined_up(position_noise=0.01, orientation_noise=0.02, linear_velocity_noise=0.1)
    noisy.command(HOVER)
    said, meant = [], []
    for _ in range(400):
        noisy.step()
        message = noisy.topic("odom")
        said.append([message["x"], message["vy"], message["wz"]])
        state = noisy.state
        meant.append([state.position[0], state.linear_velocity[1], state.angular_velocity[2]])
    deviations = np.std(np.array(said) - np.array(meant), axis=0)
    assert deviations == pytest.approx([0.01, 0.1, 0], rel=0.15)
    message = noisy.topic("odom")
    seen = Rotation.from_quat([message[name] for name in ("qx", "qy", "qz", "qw")])
    assert 0 < (seen * Rotation.from_quat(noisy.state.orientation).inv()).magnitude() < 0.2


def test_steps_whose_command_reaches_the_limit_are_counted(lined_up):
    simulation = lined_up(max_velocity=600)
    simulation.command([599, -599, 599, -599])
    simulation.step(10)
    assert simulation.topic("saturation")["steps"] == 0
    simulation.command([500, -600, 500, -500])
    simulation.step(7)
    snapshot = simulation.snapshot()
    simulation.step(3)
    assert simulation.topic("saturation")["steps"] == 10
    simulation.restore(snapshot)
    assert simulation.topic("saturation")["steps"] == 7
    simulation.reset()
    assert simulation.topic("saturation")["steps"] == 0
    assert "saturation" not in qc.Simulation(ROOT / "tests/data/thesis/quadrotor.urdf.xacro").topics
