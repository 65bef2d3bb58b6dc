"""The mathematical model in the place of an engine."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from flights import NOISE
from hooked import with_plugins
from vehicles import (
    AIR,
    COM,
    DRAG,
    FLAPPING,
    GRAVITY,
    MOTOR,
    ODD,
    SKEW,
    WIND,
    plugin,
    vehicle,
)

import quadcore as qc
from quadcore.cli import main
from quadcore.control import controllers, references
from quadcore.simulation.simulation import make_simulation
from quadcore.simulation.state import make_state
from quadcore.thesis.chapter2 import GYROSTAT, Terms
from quadcore.thesis.chapter2.plant import Plant, check

CHAPTER_2 = {
    "parameters": {"drone_plugin.dragModel": "chapter2", **NOISE},
    "xacro_args": {"sim_slow": 1},
    "seed": 5,
}


def on(reference, simulation):
    simulation.set_state(references.start(simulation, reference))
    return simulation


def apart(one, other):
    return np.abs(one.position - other.position).max()


def test_with_equal_terms_the_controller_of_the_thesis_flies_it_as_it_flies_eigen():
    spiral = references.spiral()
    controller = controllers.pd_compensated(rate=250)
    plants = [
        Plant(GYROSTAT, dt=4e-3, **CHAPTER_2),
        qc.Simulation(engine="eigen", dt=4e-3, **CHAPTER_2),
    ]
    logs = [on(spiral, plant).run(10, controller=controller, reference=spiral) for plant in plants]
    assert np.linalg.norm(logs[1].position[-1] - logs[1].position[0]) > 9
    assert apart(*logs) < 1e-8
    assert np.abs(logs[0].rotor_velocity - logs[1].rotor_velocity).max() < 1e-6


def test_so_it_does_any_vehicle_with_rate_delay_and_noise(hangar):
    air = {**AIR, **DRAG, **FLAPPING, "dragModel": "chapter2", "sim_slow": 2}
    urdf = vehicle(ODD, 1, SKEW, COM, air, {**MOTOR, "sim_slow": 2})
    urdf = with_plugins(urdf, plugin("odometry", {"rate": 200, "linearVelocityNoise": 1e-2}))
    simulation = hangar(urdf, GRAVITY, WIND, engine="eigen", dt=1e-3, spawn=(0, 0, 10))
    plant = Plant(GYROSTAT, model=simulation.model, world=simulation.world, dt=1e-3)
    hover = references.hover(x=0.1)
    controller = controllers.indi(rate=330, delay=0.003)
    logs = [s.run(0.3, controller=controller, reference=hover) for s in (plant, simulation)]
    assert apart(*logs) < 1e-8
    assert plant.topic("odom") == pytest.approx(simulation.topic("odom"), abs=1e-8)


def test_what_the_thesis_leaves_out_sets_it_apart():
    spiral = references.spiral()
    logs = [
        on(spiral, Plant(terms, dt=4e-3, **CHAPTER_2)).run(
            1, controller=controllers.pd_compensated(rate=250), reference=spiral
        )
        for terms in (Terms(), GYROSTAT)
    ]
    assert apart(*logs) > 1e-7


def test_it_goes_on_from_a_snapshot_and_a_state():
    plant = make_simulation("lagrange", dt=4e-3, **CHAPTER_2)
    plant.command([480, -475, 485, -470])
    plant.step(20)
    snapshot, state = plant.snapshot(), plant.state.copy()
    plant.step(20)
    after = plant.state.copy()
    plant.restore(snapshot)
    plant.step(20)
    assert np.array_equal(plant.state.position, after.position)
    plant.set_state(state)
    plant.step(20)
    np.testing.assert_allclose(plant.state.position, after.position, atol=1e-14)
    assert plant.engine == "lagrange"
    assert plant.time == pytest.approx(0.16)


def test_it_takes_commands_over_time_and_logs_no_wrenches():
    table = [[0, 480, -480, 480, -480], [0.1, 300, -300, 300, -300]]
    logs = [
        make_simulation(engine, dt=4e-3, **CHAPTER_2).run(0.2, commands=table)
        for engine in ("lagrange", "eigen")
    ]
    assert logs[0].wrenches == {}
    assert np.abs(logs[0].rotor_velocity - logs[1].rotor_velocity).max() < 1
    assert apart(*logs) < 1e-3


def test_angles_of_the_rotors_turn_with_them():
    plant = make_simulation("lagrange", dt=4e-3, **CHAPTER_2)
    plant.command([480, -480, 480, -480])
    plant.step()
    assert (np.sign(plant.state.rotor_angle) == [1, -1, 1, -1]).all()


def test_a_pitch_of_90_degrees_ends_the_flight():
    plant = make_simulation("lagrange", dt=4e-3, spawn=(0, 0, 10, 0, np.pi / 2, 0), **CHAPTER_2)
    with pytest.raises(qc.FlightError, match=r"t = 0.000000 s: .*pitch reaches 90 degrees"):
        plant.step()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ("--set motorpid_plugin.ki=1 --set motorpid_plugin.iMax=1", "proportional motors"),
        ("--world default", "ground"),
        ("--wrenches --out out", "Leave wrenches out, or use another engine"),
    ],
)
def test_what_it_cannot_represent_is_refused_in_one_line(capsys, in_empty_folder, arguments, says):
    command = ["run", "quadrotor", "--engine", "lagrange", "--duration", "0.1"]
    assert main([*command, *arguments.split()]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1
    assert says in errors[0]
    assert not any(Path().iterdir())


def test_wrenches_that_it_has_not_are_refused_in_python_too():
    plant = make_simulation("lagrange", dt=4e-3, **CHAPTER_2)
    with pytest.raises(qc.InputError, match="Engine lagrange applies no forces of plugins"):
        plant.run(0.1, wrenches=True)
    assert plant.time == 0


def test_a_force_that_it_does_not_know_is_refused():
    simulation = qc.Simulation(engine="eigen", **CHAPTER_2)
    jet = SimpleNamespace(name="jet", wrenches=["push", "pull"])
    modified = SimpleNamespace(world=simulation.world, plugins=[*simulation.plugins, jet])
    with pytest.raises(qc.InputError, match="plugin 'jet' exerts push, pull, which the mathema"):
        check(modified)


def test_the_command_line_flies_it(capsys, in_empty_folder):
    command = ["run", "quadrotor", "--engine", "lagrange", "--xacro", "sim_slow:=1", "--dt", "4e-3"]
    arguments = ["--controller", "geometric:rate=250", "--reference", "spiral", "--duration", "0.2"]
    assert main([*command, *arguments, "--log", "log.mat"]) == 0
    assert re.search(r"engine +lagrange", capsys.readouterr().out)


@pytest.mark.parametrize(
    "fly",
    [
        lambda plant: plant.step(1000),
        lambda plant: [plant.step() for _ in range(1000)],
        lambda plant: plant.run(1.0),
        lambda plant: plant.run(1.0, controller=lambda t, state, reference: plant.hover_speed),
    ],
)
def test_an_interrupt_of_a_motion_is_raised_as_it_is(fly):
    """It is no failure of the model, which an exception of another kind is."""
    raised = [KeyboardInterrupt(), ValueError("no solution")]

    def motion(dt, command, members):
        if members["time"] > 0.0105:
            raise raised[0]
        return make_state(members)

    plant = qc.Simulation("quadrotor", "eigen")
    plant._move_by(motion)
    with pytest.raises(KeyboardInterrupt) as interrupted:
        fly(plant)
    assert interrupted.value is raised.pop(0)
    with pytest.raises(qc.FlightError, match=r"t = 0.011.* s: the motion was interrupted\. To"):
        plant.step()
    plant.reset()
    with pytest.raises(qc.FlightError, match="no solution"):
        fly(plant)


def test_an_interrupt_of_the_plant_keeps_the_log(alarm):
    plant = Plant(xacro_args={"sim_slow": 1})
    alarm(0.3)
    with pytest.raises(KeyboardInterrupt) as interrupted:
        plant.run(1e6, controller="pid", reference="hover")
    assert len(interrupted.value.log) > 1
