"""RotorS' inertial unit, odometry and base, and the way of commands to its motors."""

from __future__ import annotations

import numpy as np
import pytest
from fitted import R_FS, TUMBLE, X_FS, plugin
from scipy.spatial.transform import Rotation

import quadcore as qc

# The firefly has an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")


def test_speeds_for_controllers_reach_the_motors_a_step_later():
    direct, by_interface = qc.Simulation("firefly"), qc.Simulation("firefly")
    direct.step(1)
    direct.command([500] * 6)
    by_interface.publish("command_motor_speed", [500] * 6)
    for simulation in (direct, by_interface):
        simulation.step(20)
    assert direct.time == pytest.approx(by_interface.time + 0.001)
    by_interface.step(1)
    assert np.array_equal(direct.state.rotor_velocity, by_interface.state.rotor_velocity)
    # What came last counts.
    by_interface.command([300] * 6)
    by_interface.step(500)
    assert abs(by_interface.state.rotor_velocity[0]) == pytest.approx(30, abs=1e-4)
    by_interface.publish("command_motor_speed", [400] * 6)
    by_interface.step(500)
    assert abs(by_interface.state.rotor_velocity[0]) == pytest.approx(40, abs=1e-4)


def test_the_base_tells_the_speeds_before_the_motors_act():
    simulation = qc.Simulation("firefly", spawn=(0, 0, 10))
    log = simulation.run(0.1, commands=TUMBLE, topics=["motor_speed", "motor_speed_1"])
    message = log.topics["motor_speed"]
    assert np.array_equal(message["w2"][1:], 10 * log.rotor_velocity[:-1, 1])
    # The motor's own is that which it sets.
    assert np.allclose(log.topics["motor_speed_1"]["w"][1:], log.rotor_velocity[1:, 1], atol=1e-4)


def test_the_odometry_tells_of_the_centre_of_mass_and_of_the_links_origin(fitted):
    message = plugin("gauge", "odometry_plugin", linkName="mast", odometryTopic="gauge/odometry")
    simulation = fitted(message, spawn=(1, 2, 10, 0.2, -0.1, 0.5))
    log = simulation.run(1, commands=TUMBLE, topics=["gauge_odometry"])
    message = log.topics["gauge_odometry"]
    turn = Rotation.from_quat(log.orientation[:-1])
    origin = log.position[:-1] + turn.apply(X_FS)
    center = origin + (turn * R_FS).apply([0.02, 0, 0.1])
    velocity = log.linear_velocity[:-1] + turn.apply(np.cross(log.angular_velocity[:-1], X_FS))

    def rows(*fields):
        return np.array([message[f][1:] for f in fields]).T

    assert np.allclose(rows("x", "y", "z"), center, atol=1e-12)
    assert np.allclose(rows("vx", "vy", "vz"), (turn * R_FS).inv().apply(velocity), atol=1e-12)
    spin = R_FS.inv().apply(log.angular_velocity[:-1])
    assert np.allclose(rows("wx", "wy", "wz"), spin, atol=1e-12)
    between = (turn * R_FS).inv() * Rotation.from_quat(rows("qx", "qy", "qz", "qw"))
    assert between.magnitude().max() < 1e-12
    # Of a state a step before its stamp: RotorS' clock has moved on already.
    assert np.allclose(message["stamp"][1:], log.time[1:], atol=1e-12)


def test_odometry_is_measured_every_so_many_steps_and_held_back_for_some(fitted):
    prompt = plugin("prompt", "odometry_plugin", linkName="mast", odometryTopic="prompt")
    slow = plugin(
        "slow",
        "odometry_plugin",
        linkName="mast",
        odometryTopic="slow",
        measurementDivisor=4,
        measurementDelay=3,
        unknownDelay=2.7,
    )
    log = fitted(prompt, slow).run(0.1, commands=TUMBLE, topics=["prompt", "slow"])
    prompt, slow = log.topics["prompt"], log.topics["slow"]
    arrivals = np.flatnonzero(np.diff(np.nan_to_num(slow["stamp"])))
    assert np.array_equal(arrivals, np.arange(3, 100, 4))
    for row in range(4, 100, 4):
        assert slow["z"][row] == prompt["z"][row - 3]
        assert slow["stamp"][row] == pytest.approx(prompt["stamp"][row - 3] + 2)  # whole seconds


def test_noise_of_odometry_has_the_deviations_that_its_tags_give(fitted):
    message = plugin(
        "gauge",
        "odometry_plugin",
        linkName="mast",
        odometryTopic="gauge",
        noiseNormalPosition="0.1 0 0.3",
        noiseUniformLinearVelocity="0 0.6 0",
        noiseNormalQuaternion="0.02 0.02 0.02",
    )
    truth = plugin("truth", "odometry_plugin", linkName="mast", odometryTopic="truth")
    log = fitted(message, truth).run(4, topics=["gauge", "truth"])
    noisy, true = log.topics["gauge"], log.topics["truth"]

    def deviation(field):
        return (noisy[field] - true[field])[1:].std()

    assert deviation("x") == pytest.approx(0.1, rel=0.05)
    assert deviation("y") == 0
    assert deviation("z") == pytest.approx(0.3, rel=0.05)
    assert deviation("vy") == pytest.approx(0.6 / np.sqrt(3), rel=0.05)
    assert np.abs(noisy["vy"] - true["vy"])[1:].max() < 0.6
    assert noisy["position_variance"][-1] == pytest.approx(0.09)
    pairs = [np.array([m[f][1:] for f in ("qx", "qy", "qz", "qw")]).T for m in (true, noisy)]
    apart = (Rotation.from_quat(pairs[0]).inv() * Rotation.from_quat(pairs[1])).as_rotvec()
    assert apart.std(axis=0) == pytest.approx([0.02] * 3, rel=0.05)


def test_an_inertial_unit_may_take_its_noise_from_the_seed(fitted):
    def read_unit(seed, noise):
        unit = plugin("unit", "imu_plugin", linkName="mast", imuTopic="unit", noise=noise)
        return fitted(unit, seed=seed).run(0.05, topics=["unit"]).topics["unit"]["ax"][1:]

    assert np.array_equal(read_unit(1, "rotors"), read_unit(2, "rotors"))
    assert np.array_equal(read_unit(1, "seeded"), read_unit(1, "seeded"))
    assert not np.array_equal(read_unit(1, "seeded"), read_unit(2, "seeded"))


def test_a_unit_off_the_centre_feels_how_it_is_carried_round(fitted):
    unit = plugin(
        "unit",
        "imu_plugin",
        linkName="mast",
        imuTopic="unit",
        **{
            name + tag: 0
            for name in ("gyroscope", "accelerometer")
            for tag in ("NoiseDensity", "TurnOnBiasSigma")
        },
        accelerometerRandomWalk=0,
        gyroscopeBiasRandomWalk=0,
    )
    log = fitted(unit).run(0.5, commands=TUMBLE, topics=["unit"])
    message = log.topics["unit"]
    turn = Rotation.from_quat(log.orientation)
    v = log.linear_velocity + turn.apply(np.cross(log.angular_velocity, X_FS))
    # The velocity is that of the link's centre of mass, which lies elsewhere still.
    v += turn.apply(np.cross(log.angular_velocity, R_FS.apply([0.02, 0, 0.1])))
    a = np.diff(v, axis=0)[:-1] / 0.001 + [0, 0, 9.8]
    felt = (turn[1:-1] * R_FS).inv().apply(a)
    message = np.array([message[f][2:] for f in ("ax", "ay", "az")]).T
    assert np.allclose(message, felt, atol=1e-9)


def test_noise_beyond_all_numbers_is_refused(fitted):
    unit = plugin("unit", "imu_plugin", linkName="mast", imuTopic="u", gyroscopeNoiseDensity=1e300)
    with pytest.raises(
        qc.InputError, match=r"<gyroscopeNoiseDensity> .*is out of range. Use .* <= 1000000"
    ):
        fitted(unit)
