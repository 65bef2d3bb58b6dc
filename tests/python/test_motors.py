"""Motors and joints against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from faults import refusal
from gyrostat import Gyrostat
from vehicles import AIR, CROSS, HEIGHT, LIFT, MOTOR, ROUND, Rotor, start, vehicle

import quadcore as qc

ENGINES = [name for name, _ in qc.engines()]
ODE = [name for name in ENGINES if name != "eigen"]
WAYS = np.array([1, -1, 1, -1])  # balanced: the frame stays at rest, each rotor turns by itself
SPEEDS = 471 * WAYS
MOMENT = CROSS[0].inertia[2]
DAMPED = [rotor._replace(damping=1e-4) for rotor in CROSS]


def left_over(engine, log, rate):
    """What is left of a deviation that decays at a rate (1/s), at the times of a log.

    ODE's engines take explicit steps, for which the closed form is a power.
    """
    if engine == "eigen":
        return np.exp(-rate * log.time)
    return (1 - rate * log.time[1]) ** np.arange(len(log))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_motor_follows_its_command_with_its_time_constant(hangar, engine):
    simulation = hangar(vehicle(motor=MOTOR), engine=engine)
    simulation.command(SPEEDS)
    log = simulation.run(0.3)
    reached = 1 - left_over(engine, log, MOTOR["kp"] / MOMENT)  # 17.8 1/s
    assert np.allclose(log.rotor_velocity, np.outer(reached, SPEEDS), rtol=0, atol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_damped_joint_comes_to_rest_with_its_time_constant(hangar, engine):
    simulation = start(hangar(vehicle(DAMPED), engine=engine), rotor_velocity=SPEEDS)
    log = simulation.run(0.3)
    left = left_over(engine, log, 1e-4 / MOMENT)  # 3.6 1/s
    assert np.allclose(log.rotor_velocity, np.outer(left, SPEEDS), rtol=0, atol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_slowed_rotors_follow_at_the_same_pace(hangar, engine):
    def run(sim_slow):
        simulation = hangar(vehicle(motor={**MOTOR, "sim_slow": sim_slow}), engine=engine)
        simulation.command(SPEEDS)
        return simulation.run(0.3).rotor_velocity

    assert np.allclose(run(8) * 8, run(1), rtol=0, atol=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_motor_turns_the_frame_the_other_way(hangar, engine):
    simulation = hangar(vehicle(CROSS[:1], motor=MOTOR), engine=engine)
    simulation.command([471])
    log = simulation.run(0.3)
    true = Gyrostat(CROSS[:1], 1, ROUND)
    rates = zip(log.angular_velocity, log.rotor_velocity)
    momentum = np.array([true.momentum(w, W) for w, W in rates])
    assert log.angular_velocity[-1, 2] < -0.9
    assert np.abs(momentum).max() < 2e-4 * MOMENT * 471


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize(("limit", "speed"), [(1e-3, (5e-4 * 300 + 1e-3) / 6e-4), (1, 300)])
def test_the_integral_works_up_to_its_limit(hangar, engine, way, limit, speed):
    """In the end kp (target - W) + I = damping W, with I at its limit or no error left."""
    motor = {**MOTOR, "ki": 5e-3, "iMax": limit, "iMin": -limit}
    simulation = hangar(vehicle(DAMPED, motor=motor), engine=engine)
    simulation.command(300 * way * WAYS)
    simulation.step(3000)
    assert np.allclose(simulation.state.rotor_velocity, speed * way * WAYS, rtol=1e-9, atol=0)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_saturated_integral_does_not_wind_up(hangar, engine):
    """It leaves its limit as soon as the error turns, however long it was there."""

    def turn_back(after):
        motor = {**MOTOR, "ki": 5e-3, "iMax": 1e-3, "iMin": -1e-3}
        simulation = hangar(vehicle(DAMPED, motor=motor), engine=engine)
        simulation.command(300 * WAYS)
        simulation.run(after)
        simulation.command(-300 * WAYS)
        return simulation.run(1).rotor_velocity

    early = turn_back(after=3)
    assert np.allclose(early, turn_back(after=6), rtol=0, atol=1e-6)
    at_the_other_limit = -(MOTOR["kp"] * 300 + 1e-3) / 6e-4
    assert np.allclose(early[-1], at_the_other_limit * WAYS, rtol=0, atol=1e-6)


@pytest.mark.parametrize("engine", ODE)
def test_the_derivative_is_that_of_the_last_step(hangar, engine):
    """As in Gazebo, -kd (e - e of the step before)/dt, and no error before the first."""
    kd, dt = 2e-6, 1e-3
    simulation = hangar(vehicle(motor={**MOTOR, "kd": kd}), engine=engine)
    simulation.command(SPEEDS)
    log = simulation.run(0.1)
    speed, error_before = 0.0, 0.0
    for row in log.rotor_velocity:
        assert row[0] == pytest.approx(speed, abs=1e-9)
        error = speed - SPEEDS[0]
        torque = -MOTOR["kp"] * error - kd * (error - error_before) / dt
        speed, error_before = speed + dt * torque / MOMENT, error


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sim_slow", [1, 10])
@pytest.mark.parametrize("drag_model", ["appendix", "chapter2"])
def test_rotors_that_the_air_brakes_coast_to_rest(hangar, engine, sim_slow, drag_model):
    air = {**AIR, "reactionOn": "rotor", "sim_slow": sim_slow, "dragModel": drag_model}
    simulation = hangar(vehicle(air=air), engine=engine)
    log = start(simulation, rotor_velocity=SPEEDS / sim_slow).run(1)
    brake = LIFT["rotorTorqueCoeff"] * sim_slow * 471 / MOMENT
    if engine == "eigen":
        speed = 471 / (1 + brake * log.time)
    else:  # explicit steps
        speed = np.full(len(log), 471.0)
        for i in range(1, len(log)):
            speed[i] = speed[i - 1] - 1e-3 * brake * speed[i - 1] ** 2 / 471
    assert np.allclose(log.rotor_velocity, np.outer(speed, WAYS) / sim_slow, rtol=1e-6, atol=0)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_frame_feels_through_its_motor_what_brakes_a_rotor(hangar, engine):
    rotor = Rotor((0, 0, HEIGHT))
    free, driven = (
        hangar(vehicle([rotor], air={**AIR, "reactionOn": "rotor"}, motor=motor), engine=engine)
        for motor in (None, MOTOR)
    )
    free = start(free, rotor_velocity=[300]).run(1)
    assert np.abs(free.angular_velocity).max() < 1e-12  # no motor, nothing felt
    driven.command([300])
    log = driven.run(2, wrenches=True)
    momentum = driven.inertia[2, 2] * log.angular_velocity[:, 2] + MOMENT * log.rotor_velocity[:, 0]
    torque = log.wrenches["reaction"][:, 5]
    assert np.allclose(torque, -LIFT["rotorTorqueCoeff"] * log.rotor_velocity[:, 0] ** 2)
    assert momentum[-1] < -0.01
    assert momentum[-1] == pytest.approx(float(np.sum(torque[1:] + torque[:-1]) * 0.5e-3), rel=1e-3)


def test_air_cannot_drive_the_rotor_that_it_brakes(hangar):
    air = {**AIR, "reactionOn": "rotor", "reactionTorque": "thesis"}
    message = refusal(hangar, vehicle(air=air))
    assert message.endswith("is thesis. Write opposing, or remove it.")
