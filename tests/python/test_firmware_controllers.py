"""Controllers of the Crazyflie firmware and of PX4, against their equations worked out by hand."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from processes import run_command
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.control import controllers, references

FIRMWARE = ("crazyflie_pid", "mellinger", "px4")
REP4 = Path(__file__).parents[1] / "data/recordings/nanobench/rep4_excerpt.csv.gz"

PERIOD = 1 / 500
AHEAD = qc.Reference(position=(0.1, 0, 2), yaw=0)


@pytest.fixture
def crazyflie():
    simulation = qc.Simulation("crazyflie", engine="eigen", spawn=(0, 0, 2))
    state = simulation.state.copy()
    state.rotor_velocity = simulation.hover_speed
    simulation.set_state(state)
    return simulation


def call(simulation, name):
    """Thrust of each rotor relative to hover, at the first call with the reference 0.1 m ahead."""
    controller = getattr(controllers, name)()
    controller.reset(simulation)
    speeds = np.asarray(controller(0.0, simulation.state, AHEAD))
    return (speeds / simulation.hover_speed) ** 2


def test_the_pid_of_the_crazyflie_mixes_counts(crazyflie):
    tilt = 25 * 2 * 0.1 + 1 * 2 * 0.1 * 0.01  # deg, of the position loop at 100 Hz
    rate = 6 * tilt + 3 * tilt * PERIOD  # deg/s
    output = 250 * rate + 500 * rate * PERIOD  # counts
    change = output / 2 / 36000
    # Rotors in the firmware's order: front right, back right, back left, front left.
    expected = 1 + change * np.array([-1, 1, 1, -1])
    assert call(crazyflie, "crazyflie_pid") == pytest.approx(expected, rel=1e-6)


def test_mellinger_turns_the_thrust(crazyflie):
    gravity = np.linalg.norm(crazyflie.gravity)
    force = np.array([(0.4 * 0.1 + 0.05 * 0.1 * PERIOD) / 0.029, 0, gravity])  # N/kg
    pitch = np.arctan2(force[0], force[2])
    output = 70000 * 2 * np.sin(pitch)  # counts
    hover = 132000 * 0.029 * 9.81
    change = output / 2 / hover
    assert change < 0.5
    expected = 1 + change * np.array([-1, 1, 1, -1])
    assert call(crazyflie, "mellinger") == pytest.approx(expected, rel=1e-6)


def test_px4_squares_the_commands_of_the_motors(crazyflie):
    acceleration = 1.8 * 0.95 * 0.1
    pitch = np.arctan2(acceleration, 9.80665)
    rate = 6.5 * 2 * np.sin(pitch / 2)
    torque = 0.15 * rate
    thrust = 0.5 / np.cos(pitch)
    commands = thrust + torque / np.sqrt(2) * np.array([-1, 1, 1, -1])
    assert call(crazyflie, "px4") == pytest.approx((commands / 0.5) ** 2, rel=1e-6)


def test_px4_weighs_the_yaw_less_than_the_direction_of_the_thrust(crazyflie):
    controller = controllers.px4(mpc_xy_vel_i_acc=0)
    controller.reset(crazyflie)
    wanted = qc.Reference(position=(0.2, 0, 2), yaw=0.2)
    speeds = np.asarray(controller(0.0, crazyflie.state, wanted))
    commands = 0.5 * np.abs(speeds / crazyflie.hover_speed)
    acceleration = np.array([1.8 * 0.95 * 0.2, 0, 9.80665])
    z = acceleration / np.linalg.norm(acceleration)
    x = np.cross([-np.sin(0.2), np.cos(0.2), 0], z)
    x /= np.linalg.norm(x)
    attitude = Rotation.from_matrix(np.column_stack([x, np.cross(z, x), z]))
    shortest = Rotation.from_rotvec([0, np.arctan2(acceleration[0], 9.80665), 0])
    about_z = (shortest.inv() * attitude).as_rotvec()[2]
    turn = (shortest * Rotation.from_rotvec([0, 0, 0.4 * about_z])).as_quat()
    rates = 2 * np.array([6.5, 6.5, 2.8 / 0.4]) * turn[:3]
    torque = np.array([0.15, 0.15, 0.2]) * rates
    x, y = np.array([1, -1, -1, 1]), np.array([-1, -1, 1, 1])  # signs of the rotors' places
    spin = np.sign(crazyflie.hover_speed)
    expected = (torque[0] * y - torque[1] * x) / np.sqrt(2) - torque[2] * spin
    assert commands - commands.mean() == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("name", FIRMWARE)
def test_they_settle_at_a_position_through_noise(name):
    noise = {"odometry.positionNoise": "0.0002", "odometry.orientationNoise": "0.0002"}
    simulation = qc.Simulation(
        "crazyflie", engine="eigen", spawn=(0, 0, 2), parameters=noise, seed=3
    )
    hover = references.hover(x=0.3, y=-0.2, height=2.1, yaw=0.2)
    log = simulation.run(25, controller=name, reference=hover, log_every=10)
    late = log.time > 20
    error = log.position[late] - [0.3, -0.2, 2.1]
    assert np.abs(error.mean(axis=0)).max() < 0.01
    yaw = Rotation.from_quat(log.orientation[late]).as_euler("ZYX")[:, 0]
    assert yaw.mean() == pytest.approx(0.2, abs=0.01)


def test_the_pid_lags_a_ramp_by_the_gain_of_its_position_loop(crazyflie):
    """Only positions are tracked: a velocity v needs the position error v / kp."""
    ramp = references.ramp(height=2, vx=0.4, time=0)
    log = crazyflie.run(10, controller="crazyflie_pid", reference=ramp, log_every=10)
    assert log.topics["error"]["x"][-1] == pytest.approx(-0.4 / 2, abs=0.01)


def test_the_velocity_of_the_pid_is_limited(crazyflie):
    step = references.hover(x=8, height=2)
    log = crazyflie.run(6, controller="crazyflie_pid", reference=step, log_every=10)
    assert 1.0 < log.linear_velocity[:, 0].max() < 1.2
    tilt = Rotation.from_quat(log.orientation).as_euler("ZYX")[:, 1:]
    assert np.degrees(np.abs(tilt)).max() < 24


@pytest.mark.parametrize("name", ["mellinger", "px4"])
def test_velocities_of_the_reference_are_fed_forward(name, crazyflie):
    ramp = references.ramp(height=2, vx=0.4, time=0)
    log = crazyflie.run(12, controller=name, reference=ramp, log_every=10)
    assert abs(log.topics["error"]["x"][-1]) < 0.05


def test_mellinger_flies_as_low_as_the_real_vehicle_if_it_demands_as_little_thrust(tmp_path):
    """The firmware demands the weight of 29 g in hover, at 132000 counts per newton."""
    heights = {}
    demanded, needed = 0.029 * 9.81 * 132000 / 65535, 0.786
    for factor in (1, demanded / needed):
        controller = f"mellinger:believed_mass={factor:.4g}"
        done = run_command(
            "predict", "crazyflie", "--log", REP4, "--controller", controller, "--force",
            "--out", tmp_path,
        )  # fmt: skip
        assert f"mean motor command {needed}" in done.stdout
        measured, flown = (qc.Log.of_file(tmp_path / f"logs/{n}.csv") for n in (1, 2))
        heights[factor] = np.mean(flown.position[100:, 2] - measured.position[100:, 2])
    by_model, by_firmware = heights.values()
    assert 0.06 < by_model < 0.12
    assert abs(by_firmware) < 0.04


def test_setpoints_of_a_real_flight_are_flown_with_the_lag_of_the_firmware(tmp_path):
    done = run_command(
        "predict", "crazyflie", "--log", REP4, "--controller", "crazyflie_pid", "--force",
        "--out", tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    replayed = re.search(r"replay with crazyflie_pid +([\d.]+)", done.stdout)
    undelayed = re.search(r"set-points +([\d.]+)", done.stdout)
    assert float(replayed[1]) < 0.3 * float(undelayed[1])
