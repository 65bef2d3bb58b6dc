"""Controllers that end above the rotors: attitudes and rates with a thrust."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from flights import ENGINES, quadrotor

import quadcore as qc
from quadcore.control import controllers, references

WEIGHT = 1.04 * 9.8  # N
SLOW = {"drone_plugin.sim_slow": 1, "motorpid_plugin.sim_slow": 1}


def attitude(axis, angle):
    """A quaternion x, y, z, w."""
    axis = np.asarray(axis) / np.linalg.norm(axis)
    return np.append(axis * np.sin(angle / 2), np.cos(angle / 2))


def fly_constant(engine, asked, seconds=3, **options):
    """A flight of what always asks for the same."""
    simulation = quadrotor(engine, parameters=SLOW, **options)
    return simulation.run(seconds, controller=lambda t, state, reference: asked)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_attitude_is_reached_and_held(engine):
    wanted = attitude([0.4, -0.2, 0.8], 0.5)
    log = fly_constant(engine, qc.AttitudeThrust(wanted, WEIGHT), 5, spawn=(0, 0, 80, 0.3, 0, -0.6))
    reached = np.abs(log.orientation[log.time > 4] @ wanted)  # yaw is slow by its gains
    assert 2 * np.arccos(np.minimum(reached, 1)).max() < 5e-3
    assert np.abs(log.angular_velocity[-1]).max() < 0.02


@pytest.mark.parametrize("engine", ENGINES)
def test_from_upside_down_an_attitude_is_reached(engine):
    level = qc.AttitudeThrust([0, 0, 0, 1], WEIGHT)
    log = fly_constant(engine, level, spawn=(0, 0, 50, np.pi, 0, 0))
    assert abs(log.orientation[-1, 3]) > 1 - 1e-4


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("wanted", [(0, 0, 0.8), (0.7, -0.4, 0.3)])
def test_rates_are_reached_and_held(engine, wanted):
    # Until it lies over. Gazebo's damping takes its share of what rates alone are held by.
    log = fly_constant(engine, qc.RatesThrust(wanted, WEIGHT), 1.8, spawn=(0, 0, 80))
    assert np.abs(log.angular_velocity[log.time > 1.5] - wanted).max() < 0.03


class Outer:
    """Hovers at a place, its own outer loop down to an attitude and a thrust."""

    rate = 100
    goal = np.array([0.5, -0.3, 20.4])

    def __call__(self, t, state, reference):
        lift = 4 * (self.goal - state.position) - 4 * state.linear_velocity + [0, 0, 9.8]
        x, y, z = lift / np.linalg.norm(lift)
        half = np.array([-y, x, 0, 1 + z])  # from z up to the lift, by the shortest way
        return qc.AttitudeThrust(half / np.linalg.norm(half), 1.04 * np.linalg.norm(lift))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("slow", [1, 10])
def test_an_outer_loop_of_ten_lines_hovers(engine, slow):
    parameters = dict.fromkeys(SLOW, slow)
    simulation = quadrotor(engine, parameters=parameters, spawn=(0, 0, 20))
    log = simulation.run(12, controller=Outer())
    assert np.linalg.norm(log.position[-1] - Outer.goal) < 1e-3


def test_it_commands_what_the_geometric_controller_does_inside():
    hover = references.hover(x=0.4, y=-0.3, height=20.2, yaw=0.5)
    plain = {"integral": False, "flat_rates": False, "drag": False}
    inside = controllers.geometric(**plain)

    class Same:
        """The outer loop of the controller, written again."""

        inner_loop = qc.InnerLoop(drag=False)

        def __call__(self, t, state, reference):
            error = reference.position - state.position
            gains = np.array([9, 9, 16]), np.array([5.4, 5.4, 8])
            force = 1.04 * (gains[0] * error - gains[1] * state.linear_velocity + [0, 0, 9.8])
            z = force / np.linalg.norm(force)
            x = np.cross([-np.sin(0.5), np.cos(0.5), 0], z)
            x /= np.linalg.norm(x)
            turned = np.column_stack([x, np.cross(z, x), z])
            qx, qy, qz, qw = state.orientation
            up = np.array(
                [2 * (qx * qz + qw * qy), 2 * (qy * qz - qw * qx), 1 - 2 * (qx * qx + qy * qy)]
            )
            return qc.AttitudeThrust(quaternion(turned), force @ up)

    logs = [
        quadrotor("eigen", parameters=SLOW, spawn=(0, 0, 20)).run(
            2, controller=controller, reference=hover
        )
        for controller in (inside, Same())
    ]
    assert np.abs(logs[0].table - logs[1].table).max() < 1e-6


def quaternion(matrix):
    """x, y, z, w of a rotation by less than half a turn."""
    w = np.sqrt(1 + np.trace(matrix)) / 2
    skew = matrix - matrix.T
    return np.append(np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) / (4 * w), w)


def test_speeds_and_attitudes_may_alternate():
    def controller(t, state, reference):
        if t < 0.5:
            return np.array([480, -480, 480, -480])
        return qc.RatesThrust([0, 0, 0], WEIGHT)

    log = quadrotor("eigen", parameters=SLOW).run(1, controller=controller)
    assert np.abs(log.angular_velocity[-1]).max() < 1e-3


def test_a_controller_is_copied_with_its_inner_loop():
    controller = Outer()
    controller.inner_loop = qc.InnerLoop(kr_rp=200)
    tables = []
    for copied in (
        lambda controller: controller,
        copy.deepcopy,
        lambda controller: pickle.loads(pickle.dumps(controller)),
    ):
        flown_by = copied(controller)  # after the first flight
        simulation = quadrotor("eigen", parameters=SLOW, spawn=(0, 0, 20))
        tables.append(simulation.run(0.5, controller=flown_by).table)
    np.testing.assert_array_equal(tables[0], tables[1])
    np.testing.assert_array_equal(tables[0], tables[2])


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (qc.AttitudeThrust([0, 0, 0, 2], 10), "orientation has length 2. Give a unit quaternion"),
        (qc.AttitudeThrust([0, 0, 1], 10), "Give 4 finite numbers"),
        (qc.AttitudeThrust("level", 10), "AttitudeThrust: its orientation"),
        (
            qc.AttitudeThrust([0, 0, 0, 1], np.nan),
            "AttitudeThrust: its thrust is nan. Give a force",
        ),
        (qc.RatesThrust([0, 0, np.inf], 10), "RatesThrust: its angular_velocity is"),
        (qc.RatesThrust([0, 0, 0], "much"), "RatesThrust: its thrust is 'much'. Give a force in N"),
    ],
)
def test_what_is_no_attitude_or_rate_is_refused(asked, says):
    simulation = quadrotor("eigen")
    with pytest.raises(qc.InputError, match=says):
        simulation.run(1, controller=lambda t, state, reference: asked)


def test_parameters_of_the_inner_loop_are_checked_and_documented():
    def controller(t, state, reference):
        return qc.RatesThrust([0, 0, 0], WEIGHT)

    for loop, says in (
        (qc.InnerLoop(kr_pr=1), r"inner loop has no parameter 'kr_pr'\. Did you mean 'kr_rp'\?"),
        (qc.InnerLoop(spins=[1, 1]), "the spins are not 4 signs"),
        ("stiff", "its inner_loop is 'stiff'. Give a quadcore.InnerLoop"),
    ):
        controller.inner_loop = loop
        with pytest.raises(qc.InputError, match=says):
            quadrotor("eigen").run(1, controller=controller)
    assert "kr_rp : float, default 300" in qc.InnerLoop.__doc__


def wrench_by_hand(sim, squared):
    """Thrust along z and torque about the centre of mass, from the geometry of each rotor."""
    total = np.zeros(4)
    for rotor, square in zip(sim.rotors, squared):
        force = rotor.thrust_coefficient * square * rotor.axis
        reaction = rotor.torque_sense * rotor.spin * rotor.torque_coefficient * square * rotor.axis
        total += [force[2], *(np.cross(rotor.position, force) + reaction)]
    return total


@pytest.mark.parametrize("model", ["quadrotor", "hexarotor", "hummingbird"])
def test_a_torque_and_a_thrust_are_those_of_the_commanded_speeds(model):
    sim = qc.Simulation(model, engine="eigen")
    weight = sim.mass * 9.8
    wanted = qc.WrenchThrust([0.02 * weight * 0.1, -0.01 * weight * 0.1, 1e-4 * weight], weight)
    loop = qc.InnerLoop(lead=False)
    speeds = loop.speeds(sim, 0.002, qc.Odometry(sim), wanted)
    exerted = wrench_by_hand(sim, speeds**2)
    assert exerted == pytest.approx([wanted.thrust, *wanted.torque], rel=1e-6, abs=1e-9)
    assert sim.vehicle.allocation @ speeds**2 == pytest.approx(exerted, rel=1e-6, abs=1e-9)
    assert np.array_equal(np.sign(speeds), sim.vehicle.spins)


def test_a_torque_of_two_numbers_is_refused():
    with pytest.raises(qc.InputError, match=r"its torque is .* Give 3 finite numbers"):
        fly_constant("eigen", qc.WrenchThrust([1, 2], WEIGHT), 0.1)
