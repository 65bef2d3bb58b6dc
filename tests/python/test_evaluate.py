"""Controllers evaluated: what is flown and summed."""

from __future__ import annotations

import numpy as np
import pytest
from evaluations import evaluate
from flights import NOISE

import quadcore as qc
from quadcore.control import controllers, references


def test_a_row_is_what_the_flight_by_itself_is():
    found = evaluate(["pd", "geometric"], "circle", seeds=2, parameters=NOISE, seed=3)
    circle = references.circle()
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1}, parameters=NOISE, seed=4)
    simulation.set_state(references.start(simulation, circle))
    log = simulation.run(1, controller="geometric", reference=circle, log_every=10)
    away = np.linalg.norm([log.topics["error"][axis] for axis in "xyz"], axis=0)
    row = found.table[-1]
    assert (row["controller"], row["seed"], row["failure"]) == ("geometric", 4, "")
    assert row["max_position"] == away.max()
    assert [r["seed"] for r in found.table] == [3, 4, 3, 4]
    group = found.groups[1]
    apart = [found.table[2 + i]["rms_position"] - found.table[i]["rms_position"] for i in range(2)]
    assert group["difference_rms_position"] == pytest.approx(np.mean(apart))
    assert group["flights"] == 2


def test_the_number_of_processes_changes_nothing():
    whole = [
        evaluate(["pd", "indi"], "circle", seeds=3, parameters=NOISE, processes=n)[:3]
        for n in (1, 3)
    ]
    assert str(whole[0]) == str(whole[1])  # NaN is what it is


def test_conditions_reach_plant_world_and_controller():
    found = evaluate(
        {"mine": controllers.geometric(kp_xy=7)},
        "circle",
        vary={"controller.delay": [0, 0.02], "frame.mass": [1.0, 1.3], "xacro.sim_slow": [1, 2]},
        xacro_args={},
        duration=0.5,
    )
    assert len(found.table) == 8
    assert found.table[0]["scenario"] == "controller.delay=0 frame.mass=1.0 xacro.sim_slow=1"
    assert len({row["max_position"] for row in found.table}) == 8
    assert not any(row["failure"] for row in found.table)


def test_a_lost_vehicle_is_a_failure_with_its_time():
    found = evaluate("pid_thesis:rate=1000", "spiral", duration=15)
    assert found.table[0]["failure"].startswith("lost at t = ")
    assert np.isnan(found.table[0]["rms_position"])
    assert found.groups[0]["failure_rate"] == 1


def test_models_with_other_rotors_fly_beside_each_other():
    found = evaluate("geometric", "hover", models=["hexarotor", "crazyflie"], xacro_args={})
    assert [row["model"] for row in found.table] == ["hexarotor", "crazyflie"]
    assert max(row["max_position"] for row in found.table) < 0.01
