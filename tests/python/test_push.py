"""libpush_plugin.so: a wrench on any link, published from outside."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import G, assert_same_bytes, fly, make_motored, with_fixed_link, with_plugins
from scipy.spatial.transform import Rotation
from vehicles import ODD, SKEW, plugin, start, text, vehicle, wrenches

import quadcore as qc

ARM, TURN = (0.11, -0.07, 0.05), (0.4, -0.7, 1.1)
POINT = (0.02, 0.03, -0.01)
FORCE, TORQUE = np.array([1.5, -0.7, 0.4]), np.array([0.03, 0.02, -0.05])


def add_push(rotors=(), **tags):
    urdf = vehicle(rotors, mass=1.3, inertia=SKEW, com=(0.01, -0.02, 0.03))
    urdf = with_fixed_link(urdf, "arm", 0.05, (1e-5, 2e-5, 2.5e-5), ARM, TURN)
    return with_plugins(urdf, plugin("push", tags))


def measure_push(simulation):
    """Force and torque about the centre of mass, frame axes, once a step has begun."""
    state = simulation.state.copy()
    simulation.publish("push", [*FORCE, *TORQUE])
    simulation.step()
    simulation.set_state(state)
    return wrenches(simulation)["push"]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("axes", ["world", "link"])
@pytest.mark.parametrize("link", ["frame", "arm"])
def test_a_push_acts_at_its_point_in_its_axes(link, axes, engine, hangar):
    simulation = hangar(
        add_push(link=link, axes=axes, xyz=text(POINT)),
        spawn=(1, 2, 3, 0.3, 0.2, 0.1),
        engine=engine,
    )
    R_WF = Rotation.from_quat(simulation.state.orientation.copy())
    R_FL = Rotation.from_euler("xyz", TURN) if link == "arm" else Rotation.identity()
    turn = R_WF.inv() if axes == "world" else R_FL
    p_FQ = R_FL.apply(POINT) + (ARM if link == "arm" else 0)
    f, tau = turn.apply(FORCE), turn.apply(TORQUE)
    expected = [*f, *(tau + np.cross(p_FQ - simulation.center_of_mass, f))]
    assert np.allclose(measure_push(simulation), expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("axes", ["world", "link"])
def test_a_push_on_a_rotor_moves_the_whole_by_the_laws_of_momentum(axes, engine, hangar):
    tags = {"link": "propeller2", "axes": axes, "xyz": text(POINT)}
    simulation = hangar(
        add_push(ODD, **tags), spawn=(0, 0, 0, 0.3, 0.2, 0.1), engine=engine, dt=1e-5
    )
    start(simulation, rotor_angle=[0.3, -0.8, 0.1, 2])
    state = simulation.state.copy()
    simulation.publish("push", [*FORCE, *TORQUE])
    simulation.step()
    R_WF = Rotation.from_quat(np.array(state.orientation))
    R_FR = Rotation.from_euler("xyz", ODD[1].rpy) * Rotation.from_euler("z", -0.8)
    turn = R_WF.inv() if axes == "world" else R_FR
    f, tau = turn.apply(FORCE), turn.apply(TORQUE)
    # The force moves the centre of mass; the torque about its axis spins the rotor.
    c = simulation.center_of_mass
    v = R_WF.inv().apply(simulation.state.linear_velocity.copy())
    w = simulation.state.angular_velocity.copy()
    assert np.allclose(simulation.mass * (v + np.cross(w, c)), 1e-5 * f, rtol=2e-4, atol=1e-11)
    p_FQ = np.array(ODD[1].xyz) + R_FR.apply(POINT)
    axis = R_FR.apply([0, 0, 1])
    about_axis = axis @ (tau + np.cross(R_FR.apply(POINT), f))
    spins = simulation.state.rotor_velocity + [
        Rotation.from_euler("xyz", rotor.rpy).apply([0, 0, 1]) @ w for rotor in ODD
    ]
    moments = [rotor.inertia[2] for rotor in ODD]
    assert moments[1] * spins[1] == pytest.approx(1e-5 * about_axis, rel=2e-3)
    assert np.allclose(np.delete(moments * spins, 1), 0, atol=2e-3 * abs(1e-5 * about_axis))
    # All of it turns the vehicle about its centre of mass, as if it were one body with free axes.
    total = np.cross(p_FQ - c, f) + tau
    angular = simulation.inertia @ w + sum(
        moment * rate * Rotation.from_euler("xyz", rotor.rpy).apply([0, 0, 1])
        for moment, rate, rotor in zip(moments, simulation.state.rotor_velocity, ODD)
    )
    assert np.allclose(angular, 1e-5 * total, rtol=0, atol=2e-3 * 1e-5 * np.abs(total).max())


@pytest.mark.parametrize("engine", ENGINES)
def test_a_push_lasts_its_time_or_until_the_next(engine, hangar):
    lasting, timed = (hangar(add_push(**tags), engine=engine) for tags in ({}, {"duration": 0.05}))
    for simulation in (lasting, timed):
        simulation.step(10)
        assert not simulation.state.linear_velocity.any()
        simulation.publish("push", [1.38, 0, 0, 0, 0, 0])
        simulation.step(50)
    assert np.array_equal(lasting.state.linear_velocity, timed.state.linear_velocity)
    for simulation in (lasting, timed):
        simulation.step(50)
    # 1.38 N on about 1.35 kg, until the next message.
    assert np.linalg.norm(lasting.state.linear_velocity) > 0.09
    assert np.linalg.norm(timed.state.linear_velocity) < 0.065
    lasting.publish("push", [0] * 6)
    momentum = lasting.state.linear_velocity.copy()
    lasting.step(1)
    assert np.allclose(lasting.state.linear_velocity, momentum, atol=1e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_push_by_time_is_logged_from_the_row_on_from_which_it_moves_the_vehicle(engine, hangar):
    simulation = hangar(add_push(pushes=f"0.02 0.03 {text(FORCE)} {text(TORQUE)}"), engine=engine)
    log = simulation.run(0.1, wrenches=True)
    logged = log.wrenches["push"].any(axis=1)
    moves = np.diff(log.linear_velocity, axis=0).any(axis=1)
    assert list(np.flatnonzero(logged)) == list(range(20, 50))
    assert moves[20] and not moves[19]
    gained = log.linear_velocity[50] + np.cross(
        Rotation.from_quat(log.orientation[50]).apply(log.angular_velocity[50]),
        Rotation.from_quat(log.orientation[50]).apply(simulation.center_of_mass),
    )
    assert np.allclose(gained, 0.03 * FORCE / simulation.mass, rtol=0.01)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_push_survives_a_snapshot(engine, hangar):
    urdf = with_plugins(make_motored(), plugin("push", {"duration": 0.1, "link": "propeller3"}))
    simulation = hangar(urdf, G, engine=engine)
    simulation.publish("push", [*FORCE, *TORQUE])
    fly(simulation, 50)
    middle = simulation.snapshot()
    second = fly(simulation, 100)
    simulation.restore(middle)
    assert_same_bytes(second, fly(simulation, 100))


def test_a_link_that_is_not_there_is_refused_with_the_nearest(hangar):
    with pytest.raises(qc.InputError, match=r"<link> 'arn' is not a link .*Did you mean 'arm'"):
        hangar(add_push(link="arn"))
