"""Plans of flights: what they fly, here and elsewhere, and what their fingerprint is of."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from flights import BUSY, MANOEUVRE, digest, fly_in_process

import quadcore as qc

PLAN = {
    "engine": "eigen",
    "xacro_args": {"sim_slow": 8},
    "parameters": {**BUSY, "drone_plugin.dragModel": "chapter2"},
    "spawn": (1, 2, 30, 0.1, -0.2, 0.3),
    "seed": 7,
    "duration": 0.5,
    "log_every": 5,
    "commands": MANOEUVRE,
}


def a_plan(**changed):
    return qc.FlightPlan.of("quadrotor", "default", **{**PLAN, **changed})


def test_a_plan_flies_what_simulation_and_run_fly():
    simulation = qc.Simulation(
        "quadrotor",
        world="default",
        **{key: PLAN[key] for key in ("engine", "xacro_args", "parameters", "spawn", "seed")},
    )
    expected = simulation.run(0.5, MANOEUVRE, 5, wrenches=True)
    log = a_plan(wrenches=True).fly()
    assert log.table.tobytes() == expected.table.tobytes()
    assert log.wrenches.keys() == expected.wrenches.keys()
    assert a_plan().fly().wrenches == {}
    assert list(a_plan(topics=("odom",)).fly().topics) == ["odom"]


def test_a_plan_begins_with_its_rotors_turning():
    plan = a_plan(rotor_velocity=(50, -51, 52, -53), commands=None)
    assert plan.simulation().state.rotor_velocity.tolist() == [50, -51, 52, -53]
    with pytest.raises(qc.InputError, match="4 rotors"):
        a_plan(rotor_velocity=(50, -51)).simulation()


def test_a_plan_flies_elsewhere_as_here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    header = ",".join(["t", "w1", "w2", "w3", "w4"])
    np.savetxt("c.csv", MANOEUVRE, "%.17g", ",", header=header, comments="")
    plan = a_plan(commands="c.csv")
    os.remove("c.csv")
    source = "def fly(plan):\n    return plan.fly().table.tobytes()\n"
    assert fly_in_process(source, plan) == digest(a_plan().fly().table.tobytes())
    source = "def fly(plan):\n    return plan.fingerprint().encode()\n"
    assert fly_in_process(source, plan) == digest(plan.fingerprint().encode())


def test_the_fingerprint_is_of_what_flies_not_of_where_it_lies(toy, tmp_path):
    def fingerprint(model="toy.urdf", world="toy.world", commands=((0, 300),), **options):
        return qc.FlightPlan.of(model, world, commands=np.array(commands), **options).fingerprint()

    (tmp_path / "sub").mkdir()
    Path("sub/other.urdf").write_bytes(Path("toy.urdf").read_bytes())
    assert fingerprint() == fingerprint("sub/other.urdf", dt=0.001) == fingerprint(duration=10)
    Path("windy.world").write_text(Path("toy.world").read_text().replace("1 0 0", "0 3 0"))
    others = [
        fingerprint("quadrotor", commands=[[0, 1, 2, 3, 4]]),
        fingerprint(world="windy.world"),
        fingerprint(commands=[[0, 300.00000000000006]]),
        fingerprint(engine="eigen"),
        fingerprint(dt=0.0005),
        fingerprint(seed=1),
        fingerprint(parameters={"motor.kp": 1e-3}),
        fingerprint(spawn=(0, 0, 11)),
        fingerprint(rotor_velocity=(1,)),
        fingerprint(duration=9),
        fingerprint(log_every=2),
        fingerprint(wrenches=True),
        fingerprint(topics=("vel_cmd",)),
    ]
    assert len({fingerprint(), *others}) == 1 + len(others)


def test_what_is_wrong_with_a_plan_is_said_before_it_flies(toy):
    for options, says in (
        ({"model": "nope.urdf"}, "nope.urdf: neither a file"),
        (
            {"ignore": ["blob"]},
            "ignore blob: neither the model nor the world has anything of that name",
        ),
        ({"spawn": (1, 2)}, "spawn is"),
        ({"seed": -1}, "seed is -1"),
        ({"commands": [[0, 1, 2]]}, "Give \\(rows, 2\\): t,w1"),
        ({"commands": "nope.csv"}, "nope.csv: cannot be read"),
        ({"model": qc.read_model("toy.urdf"), "xacro_args": {"a": 1}}, "has already been read"),
    ):
        with pytest.raises(qc.InputError, match=says):
            qc.FlightPlan.of(**{"model": "toy.urdf", **options})
