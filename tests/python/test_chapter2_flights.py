"""The model of chapter 2 in flight, beside the engine that is to equal it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from vehicles import (
    AIR,
    COM,
    CROSS,
    DRAG,
    FLAPPING,
    GRAVITY,
    MOTOR,
    ODD,
    SKEW,
    WIND,
    start,
    vehicle,
)

import quadcore as qc
from quadcore.thesis.chapter2 import GYROSTAT, THESIS, MathematicalModel, Terms, Vehicle
from quadcore.thesis.validation.prescribed_speeds import STIFFNESS, fly_prescribed_speeds

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
        paths.append(fly_prescribed_speeds(stiff, vehicle_, FLIGHT, 10, every, lag).position)
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
    with pytest.raises(
        qc.InputError, match=r"needs one plugin libaerodynamic_plugin\.so, but got 0"
    ):
        Vehicle.of(hangar(vehicle(motor=MOTOR)))


def test_rotors_stand_in_the_order_of_the_command():
    order = ["rotor3", "rotor1", "rotor4", "rotor2"]
    tags = {"motorpid_plugin.rotorJoints": order}
    turned = Vehicle.of(qc.Simulation("quadrotor", parameters=tags))
    plain = Vehicle.of(qc.Simulation("quadrotor"))
    assert np.array_equal(turned.arms, plain.arms[[2, 0, 3, 1]])
