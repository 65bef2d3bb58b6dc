"""The vehicles of RotorS, with controllers of quadcore."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main
from quadcore.control import references

# Firefly, iris and ardrone have an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

ENGINES = [name for name, _ in qc.engines()]
VEHICLES = ("firefly", "hummingbird", "pelican", "iris", "ardrone", "neo11")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("model", VEHICLES)
def test_the_controllers_fly_the_vehicles_of_rotors_in_its_world(model, engine):
    simulation = qc.Simulation(model, engine=engine, world="basic", spawn=(0, 0, 10))
    assert simulation.dt == 0.01
    step = references.step(dx=1)
    log = simulation.run(12, controller="geometric", reference=step, log_every=10)
    assert np.linalg.norm(log.position[-1] - step(12).position) < 0.01


@pytest.mark.parametrize("controller", ["geometric", "indi", "lqr", "pid"])
@pytest.mark.parametrize("model", VEHICLES)
def test_every_controller_hovers_the_vehicles_of_rotors(model, controller):
    hover = references.hover()
    simulation = qc.Simulation(model, world="basic")
    simulation.set_state(references.start(simulation, hover))
    log = simulation.run(3, controller=controller, reference=hover, log_every=10)
    assert np.abs(log.position - log.position[0]).max() < 1e-3


def test_a_vehicle_of_rotors_hovers_by_its_name_on_the_command_line(tmp_path, capsys):
    flight = ["run", "firefly", "--world", "basic", "--controller", "geometric"]
    flight += ["--reference", "hover", "--duration", "2", "--out", str(tmp_path), "--no-plots"]
    assert main(flight) == 0
    log = np.genfromtxt(tmp_path / "log.csv", delimiter=",", names=True)
    assert np.abs(log["z"] - log["z"][0]).max() < 1e-3


# Mass, gain of the place and thrust per squared speed that rotors_gazebo/resource gives the
# controller.
BELIEVED = {
    "firefly": (1.56779, 6, 8.54858e-06),
    "hummingbird": (0.716, 4, 8.54858e-06),
    "pelican": (1.0, 4, 9.9865e-06),
}


@pytest.mark.parametrize("model", BELIEVED)
def test_rotors_own_controller_hovers_as_far_off_as_its_numbers_are_from_the_vehicles(model):
    """The vertical part of its law: thrust m g - kp e - kv v, shared by all rotors."""
    mass, kp, k = BELIEVED[model]
    simulation = qc.Simulation(model, world="basic", spawn=(0, 0, 1))
    rotors = len(simulation.state.rotor_velocity)
    simulation.step(1)
    for _ in range(800):
        odometry = simulation.topic("odometry_sensor1_odometry")
        thrust = mass * 9.81 - kp * (odometry["z"] - 1) - 4.7 * odometry["vz"]
        simulation.publish("command_motor_speed", [np.sqrt(max(thrust, 0) / rotors / k)] * rotors)
        simulation.step(1)
    expected = (mass * 9.81 - simulation.mass * 9.8) / kp
    assert odometry["z"] - 1 == pytest.approx(expected, abs=1e-4)


def checkout():
    """Where ROS_PACKAGE_PATH has rotors_description, or None."""
    folders = map(Path, os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep))
    found = (p for f in folders if f.is_dir() for p in f.rglob("rotors_description/package.xml"))
    return next((path.parent for path in found), None)


@pytest.mark.parametrize("model", VEHICLES)
def test_a_file_of_rotors_own_flies_as_it_is(model):
    folder = checkout()
    if folder is None:
        pytest.skip("ROS_PACKAGE_PATH names no checkout of RotorS")
    path = folder / "urdf" / "mav_generic_odometry_sensor.gazebo"
    arguments = {"mav_name": model, "namespace": model, "log_file": model}
    arguments.update(enable_logging="false", enable_ground_truth="true")
    arguments.update(enable_mavlink_interface="false", wait_to_record_bag="false")
    simulation = qc.Simulation(path, world="basic", spawn=(0, 0, 10), xacro_args=arguments)
    simulation.set_state(references.start(simulation, references.hover()))
    log = simulation.run(3, controller="geometric", reference="hover", log_every=10)
    assert np.abs(log.position - log.position[0]).max() < 1e-3
    assert {"imu", "ground_truth_odometry", "odometry_sensor1_odometry"} <= set(simulation.topics)
