"""Links behind locked joints: bodies of their own in gazebo11, parts of their parents elsewhere."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

CASE = Path(__file__).resolve().parents[1] / "data/gazebo11/random/F_locked_3102"
HIGH, LOW = (0, 0, 20, 0.3, 0.2, 0.1), (0, 0, 1.5, 0.3, 0.2, 0.1)


def vehicle(folder, joints="revolute", **changes):
    """The recorded vehicle, whose two sensors hang on joints of this type, with round rotors."""
    text = (CASE / "model.urdf").read_text()
    assert text.count("revolute") == 2
    inertias = re.findall("<inertia [^>]*>", text)
    text = text.replace(inertias[5], inertias[4])
    for part, other in changes.items():
        text = text.replace(f'<link name="{part}">', f'<link name="{part}">{other}')
    file = folder / f"{joints}.urdf"
    file.write_text(text.replace("revolute", joints))
    return file


@pytest.fixture
def locked(tmp_path):
    return vehicle(tmp_path)


def test_users_see_the_vehicle_that_they_see_with_fixed_joints(tmp_path):
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    simulations = {
        joints: qc.Simulation(vehicle(tmp_path, joints, sens1=ball), spawn=HIGH)
        for joints in ("revolute", "fixed")
    }
    locked, fixed = simulations["revolute"], simulations["fixed"]
    assert locked.rotor_names == fixed.rotor_names
    names = [[link.name for link in simulation.model.links] for simulation in (locked, fixed)]
    assert names[0] == names[1]
    assert locked.mass == pytest.approx(fixed.mass, rel=1e-5)
    assert np.allclose(locked.inertia, fixed.inertia, rtol=1e-4, atol=1e-6)
    columns = [simulation.run(0.1).columns for simulation in (locked, fixed)]
    assert columns[0] == columns[1]
    assert np.allclose(locked.state.position, fixed.state.position, rtol=0, atol=1e-4)


@pytest.mark.parametrize("spawn", [HIGH, LOW], ids=["in flight", "on the ground"])
def test_restoring_repeats_the_bytes(tmp_path, spawn):
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    model = vehicle(tmp_path, sens1=ball, frame=ball)
    simulation = qc.Simulation(model, world="default", spawn=spawn)
    simulation.run(0.7)
    snapshot = simulation.snapshot()
    first = simulation.run(0.3).table
    other = qc.Simulation(model, world="default", spawn=spawn)
    other.restore(snapshot)
    assert other.run(0.3).table.tobytes() == first.tobytes()


def test_a_batch_flies_each_vehicle_as_it_flies_alone(locked):
    batch = qc.BatchSimulation(locked, 3, engine="gazebo11", spawn=HIGH)
    commands = np.linspace(150, 250, 15).reshape(3, 5)
    batch.step(commands, 200)
    for i in range(3):
        alone = qc.Simulation(locked, spawn=HIGH)
        alone.command(commands[i])
        alone.step(200)
        for name, rows in batch.state._asdict().items():
            np.testing.assert_array_equal(rows[i], getattr(alone.state, name))


def test_the_shapes_of_a_locked_link_touch_the_ground_with_it(tmp_path):
    """The one shape is a ball on a sensor: the ground stops the vehicle there."""
    ball = '<collision><geometry><sphere radius="0.8"/></geometry></collision>'
    stopped = []
    for joints in ("revolute", "fixed"):
        model = vehicle(tmp_path, joints, sens1=ball)
        log = qc.Simulation(model, world="default", spawn=LOW).run(0.6)
        above = log.position[:, 2] - (LOW[2] - 4.9 * log.time**2)
        stopped.append(np.argmax(above > 0.01))
        assert above[-1] > 0.1
    assert stopped[0] == stopped[1] > 100


@pytest.mark.parametrize("engine", ["gazebo11", "ode", "eigen"])
def test_a_rotor_on_a_locked_arm_lifts_and_turns_as_on_a_fixed_one(tmp_path, engine):
    flights = []
    for joints in ("revolute", "fixed"):
        model = vehicle(tmp_path, joints)
        text = model.read_text()
        rotor = text.index('<joint name="rotor1"')
        parent = text.index('<parent link="', rotor)
        text = text[:parent] + '<parent link="sens1"/>' + text[text.index("<child", parent) :]
        model.write_text(text)
        simulation = qc.Simulation(model, engine=engine, spawn=HIGH)
        simulation.command(np.linspace(20, 30, simulation.rotor_count))
        simulation.step(200)
        flights.append(simulation.state)
    locked, fixed = flights
    assert np.allclose(locked.position, fixed.position, rtol=0, atol=1e-3)
    assert np.allclose(locked.rotor_velocity, fixed.rotor_velocity, rtol=0, atol=0.05)
    assert np.allclose(locked.rotor_angle, fixed.rotor_angle, rtol=0, atol=0.01)
    assert np.abs(fixed.rotor_angle).min() > 0.1


@pytest.mark.parametrize("engine", ["ode", "eigen"])
def test_other_engines_fly_a_locked_joint_as_a_fixed_one(tmp_path, engine):
    tables = [
        qc.Simulation(vehicle(tmp_path, joints), engine=engine, spawn=HIGH).run(0.2).table
        for joints in ("revolute", "fixed")
    ]
    assert tables[0].tobytes() == tables[1].tobytes()
