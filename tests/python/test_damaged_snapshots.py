"""Snapshots, models and worlds that are damaged, empty or of another simulation are refused."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from flights import bits, quadrotor
from hooked import CARGO, G, fly, make_motored, with_fixed_link, with_plugins
from vehicles import plugin

import quadcore as qc
from quadcore import _core


def damage(snapshot, **changed):
    """A snapshot with other contents, by way of its pickle."""
    state = snapshot.__getstate__()
    state.update(changed)
    other = type(snapshot).__new__(type(snapshot))
    other.__setstate__(state)
    return other


@pytest.mark.parametrize(
    "changed",
    [
        {"start_time": float("nan")},
        {"start_time": 2e9},
        {"steps": -1},
        {"steps": 2**63 - 1},
        {"engine": np.full(13, np.nan)},
        {"plugins": np.zeros(3)},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_damaged_snapshot_is_refused_and_changes_nothing(changed):
    simulation = quadrotor("eigen")
    simulation.step(10)
    snapshot, before = simulation.snapshot(), bits(simulation)
    with pytest.raises(qc.InputError, match=r"snapshot: it is damaged\. Take a new snapshot"):
        simulation.restore(damage(snapshot, **changed))
    assert bits(simulation) == before
    simulation.restore(damage(snapshot))  # whole


VEHICLES = Path(__file__).parents[1] / "fuzz" / "vehicles"


@pytest.mark.parametrize("number", [-1, -0.5, 1e18, 1e300, np.inf, np.nan])
@pytest.mark.parametrize("vehicle", ["sensors", "flown", "rotors"])
def test_any_number_in_a_plugins_memory_flies_or_ends_the_flight(vehicle, number):
    simulation = qc.Simulation(VEHICLES / f"{vehicle}.urdf", "eigen")
    simulation.step(20)
    snapshot = simulation.snapshot()
    memory = snapshot.__getstate__()["plugins"]
    messages = set()
    for i in range(len(memory)):
        numbers = memory.copy()
        numbers[i] = number
        try:
            simulation.restore(damage(snapshot, plugins=numbers))
            simulation.step(3)
        except qc.FlightError as error:
            messages.add(str(error))
    assert any("a counter in the plugin's state is damaged" in why for why in messages)
    simulation.restore(snapshot)
    simulation.step(3)


@pytest.mark.usefixtures("hook_plugins")
def test_a_snapshot_that_is_refused_leaves_what_is_carried(hangar):
    cargo = plugin("cargo", {**CARGO, "release": 0.02})
    urdf = with_plugins(make_motored(), cargo, plugin("odometry", {}))
    simulation = hangar(urdf, G, engine="eigen")
    laden = simulation.snapshot()
    fly(simulation, 40)
    mass, before = simulation.mass, bits(simulation)
    with pytest.raises(qc.InputError, match="another model or engine"):
        simulation.restore(damage(laden, engine=laden.__getstate__()["engine"][:-1]))
    assert simulation.mass == mass
    assert bits(simulation) == before


def test_a_link_that_only_a_sensor_feels_makes_another_vehicle(hangar):
    def mount_imu(x):
        return hangar(with_fixed_link(make_motored(), "imu", 1e-9, (1e-15,) * 3, (x, 0, 0)), G)

    snapshot = mount_imu(0.1).snapshot()
    with pytest.raises(qc.InputError, match="a different model"):
        mount_imu(0.9).restore(snapshot)


def test_no_snapshot_is_none():
    with pytest.raises(qc.InputError, match="expected a Snapshot, not a 'NoneType'"):
        quadrotor().restore(None)


@pytest.mark.parametrize("name", ["Model", "World", "Snapshot"])
def test_objects_that_nothing_was_read_into_are_refused(name):
    empty = getattr(_core, name).__new__(getattr(_core, name))
    with pytest.raises(qc.InputError, match="the object is empty"):
        if name == "Snapshot":
            quadrotor().restore(empty)
        else:
            qc.Simulation(**{"model": "quadrotor", name.lower(): empty})
    with pytest.raises(qc.InputError, match="the object is empty"):
        pickle.dumps(empty)


@pytest.mark.parametrize("state", [{}, (), (1,), {"version": 1}, None, (1, 2, 3, 4, 5)])
@pytest.mark.parametrize("name", ["Model", "World", "Snapshot"])
def test_a_damaged_pickle_is_one_line(name, state):
    empty = getattr(_core, name).__new__(getattr(_core, name))
    with pytest.raises(qc.InputError, match="has a damaged pickle"):
        empty.__setstate__(state)


def test_a_plan_is_the_same_however_its_numbers_are_written():
    plan = qc.FlightPlan.of(engine="eigen", duration=0.1)
    slow = {"drone_plugin.sim_slow": "1", "motorpid_plugin.sim_slow": "1"}
    one = replace(plan, spawn=(0, 0, 5), seed=3, parameters=slow, log_every=2)
    other = replace(
        plan,
        spawn=(0, 0, 5.0, 0, 0, 0),
        seed=np.int64(3),
        parameters=dict.fromkeys(slow, 1),
        log_every=np.int64(2),
    )
    assert one.fingerprint() == other.fingerprint() != plan.fingerprint()
    commanded = other.with_commands([[0, 100, -100, 100, -100]])
    assert len(commanded.fly().table) == 51
