"""Constraints, further metrics, own columns and the limit of a failure."""

from __future__ import annotations

import csv
import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.cli import main
from quadcore.support.rotation import compute_rotation_vector

OWN = """
import quadcore as qc

class Costly:
    def __init__(self):
        self.log = {"cost": 0.0, "calls": 0}
        self.inner = qc.controllers.geometric()
    def reset(self, vehicle):
        self.inner.reset(vehicle)
    def __call__(self, t, state, reference):
        self.log["cost"] = 2 * t
        self.log["calls"] += 1
        return self.inner(t, state, reference)

class Grows(Costly):
    def __call__(self, t, state, reference):
        if t > 0.1:
            self.log["more"] = 1.0
        return super().__call__(t, state, reference)

def cost(log):
    return log.topics["controller"]["cost"][-1]

def highest(log):
    return log.position[:, 2].max()

def fails(log):
    return 1 / 0
"""
FLIGHT = {"duration": 2.0, "xacro_args": {"sim_slow": 1}}


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN)
    monkeypatch.delitem(sys.modules, "own", raising=False)


def fly(reference="circle", every=10, **options):
    sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    sim.set_state(qc.references.start(sim, qc.references.parse(reference)))
    given = {"controller": "geometric", "reference": reference, "log_every": every, **options}
    return sim, sim.run(2.0, **given)


def evaluate(controllers="geometric", **options):
    return qc.evaluate(controllers, "circle", **{**FLIGHT, **options})


@pytest.mark.parametrize("seeds", [1, 5])  # alone, and together on a batch
def test_times_in_violation_are_those_of_the_rows(seeds):
    _, log = fly()
    speed = np.linalg.norm(log.linear_velocity, axis=1)
    tilt = np.arccos(1 - 2 * (log.orientation[:, 0] ** 2 + log.orientation[:, 1] ** 2))
    acceleration = np.linalg.norm(np.gradient(log.linear_velocity, 0.01, axis=0), axis=1)
    limits = {"speed": np.median(speed) + 1e-7, "tilt": np.median(tilt) + 1e-7}
    limits["acceleration"] = np.median(acceleration)
    box = [-10, -10, 0, 1, 10, 20]
    found = evaluate(constraints={**limits, "geofence": box}, seeds=seeds)
    row = found.table[-1]
    for name, values in (("speed", speed), ("tilt", tilt)):
        expected = 0.01 * (values[:-1] > limits[name]).sum()
        assert row[f"{name}_violation"] == pytest.approx(expected, abs=1e-9)
    assert row["acceleration_violation"] == pytest.approx(1.0, abs=0.1)
    outside = 0.01 * (log.position[:-1, 0] > 1).sum()
    assert 0 < row["geofence_violation"] == pytest.approx(outside, abs=1e-9)
    assert found.groups[0]["mean_geofence_violation"] == pytest.approx(outside, abs=1e-9)


def test_the_clearance_is_a_constraint_where_there_are_obstacles():
    near = qc.evaluate(
        "geometric",
        "hover:x=0,height=2",
        world="slalom",
        engine="ode",
        constraints={"clearance": 100},
        **FLIGHT,
    ).table[0]
    assert near["clearance_violation"] == pytest.approx(2.0)
    assert np.isnan(evaluate(constraints={"clearance": 1}).table[0]["clearance_violation"])


def test_attitude_and_rates_are_compared_with_the_flat_state():
    row = qc.evaluate("geometric", "spiral", metrics=["attitude", "rates"], **FLIGHT).table[0]
    assert 0 < row["rms_attitude_error"] <= row["max_attitude_error"] < 1e-4
    assert 0 < row["rms_rate_error"] <= row["max_rate_error"] < 1e-3
    # On the circle, the position error is below 0.1 mm: the error of the attitude is that of yaw.
    row = evaluate(metrics=["attitude"]).table[0]
    assert row["max_position"] < 1e-4
    assert row["max_attitude_error"] == pytest.approx(row["max_yaw"], rel=0.1)


ESTIMATES = """
from types import SimpleNamespace
import numpy as np
import quadcore as qc

class Trusts:
    rate = 500.0
    estimate = None
    share = 1.0
    def reset(self, vehicle):
        self.law = qc.controllers.geometric()
        self.law.reset(vehicle)
    def __call__(self, t, state, reference):
        if t > 0.1:
            sizes = self.share * np.repeat([0.01, 0.02, 0.003], 3)
            self.estimate = SimpleNamespace(
                position=state.position, linear_velocity=state.linear_velocity,
                orientation=-state.orientation, covariance=np.diag(sizes**2),
            )
        return self.law(t, state, reference)

class OnlyPosition(Trusts):
    def __call__(self, t, state, reference):
        self.estimate = SimpleNamespace(position=state.position + [3, 0, 4])
        return self.law(t, state, reference)

class Wrong(Trusts):
    def __call__(self, t, state, reference):
        self.estimate = SimpleNamespace(position=state.position, covariance=np.eye(4))
        return self.law(t, state, reference)

class Singular(Trusts):
    share = 0.0
"""
NOISE = {
    "odometry.positionNoise": 0.01,
    "odometry.linearVelocityNoise": 0.02,
    "odometry.orientationNoise": 0.003,
}


def test_estimates_are_compared_with_the_truth_at_the_calls():
    Path("estimates.py").write_text(ESTIMATES)
    names = ["Trusts", "Trusts:share=2", "OnlyPosition", "Wrong", "Singular"]
    mine = ["geometric", *(f"estimates.py:{name}" for name in names)]
    table = evaluate(mine, parameters=NOISE, metrics=["estimate"]).table
    blind, right, cautious, position, wrong, singular = table
    # 950 calls with white noise: the deviation of each mean square of n components is
    # sqrt(2 / 950 / n) of it.
    for name, size in (("position", 0.01), ("velocity", 0.02), ("attitude", 0.003)):
        expected = pytest.approx(size * 3**0.5, rel=0.06)
        assert right[f"rms_estimated_{name}"] == expected
    assert right["nees"] == pytest.approx(1, abs=0.06)
    assert cautious["nees"] == pytest.approx(right["nees"] / 4, rel=1e-9)
    assert np.isnan([blind[name] for name in ("nees", "rms_estimated_position")]).all()
    assert position["rms_estimated_position"] == pytest.approx(5, abs=0.01)
    assert np.isnan([position["nees"], position["rms_estimated_attitude"]]).all()
    assert "its estimate.covariance is" in wrong["failure"] and "(3, 3)" in wrong["failure"]
    assert "estimate.covariance is not positive definite" in singular["failure"]


def test_estimates_are_compared_in_sweeps_and_with_the_attitude_of_scipy():
    Path("estimates.py").write_text(ESTIMATES)
    swept = qc.sweep(
        "estimates.py:Trusts",
        "circle",
        {"frame.mass": [1.0, 1.1]},
        parameters=NOISE,
        metrics=["estimate"],
        **FLIGHT,
    )
    assert swept.columns["nees"] == pytest.approx([1, 1], abs=0.06)
    first, second = Rotation.random(2, random_state=1)
    expected = (first.inv() * second).as_rotvec()
    for sign in (1, -1):
        found = compute_rotation_vector(first.as_quat(), sign * second.as_quat())
        assert found == pytest.approx(expected)


def test_own_columns_hold_the_values_of_the_last_call_before_each_row():
    sys.path.insert(0, "")
    try:
        log = fly(every=1, controller="own:Costly")[1]
    finally:
        sys.path.remove("")
    cost = log["controller.cost"]
    assert np.isnan(cost[0])
    # Calls every 2 ms; the row at t follows the step that the call before t commands.
    called = 2e-3 * np.floor((log.time[1:] - 5e-4) / 2e-3)
    assert np.allclose(cost[1:], 2 * called, atol=1e-9)
    assert log["controller.calls"][-1] == 1000
    with pytest.raises(qc.InputError, match="Set all names in the constructor"):
        fly(controller="own.py:Grows")


def test_own_metrics_are_columns_of_every_table():
    command = ["evaluate", "--controller", "own.py:Costly,own.py:Grows", "--reference", "circle"]
    command += ["--metric", "own.py:cost", "--metric", "own.py:highest", "--duration", "1"]
    command += ["--xacro", "sim_slow:=1", "--no-plots", "--quiet", "--out", "out"]
    assert main(command) == 3
    with open("out/table.csv") as stream:
        costly, grows = csv.DictReader(stream)
    assert float(costly["cost"]) == pytest.approx(2 * 0.998)
    assert float(costly["highest"]) == pytest.approx(10, abs=0.1)
    assert grows["cost"] == "" and "Set all names" in grows["failure"]
    content = json.loads(Path("out/evaluation.json").read_text())
    assert content["meanings"]["cost"] == "your metric own.py:cost"
    assert ">highest</th>" in Path("out/report.html").read_text()


def test_a_sweep_has_constraints_and_own_metrics():
    swept = qc.sweep(
        "geometric",
        "circle",
        {"frame.mass": [1.0, 1.1]},
        constraints={"speed": 0.0},
        metrics=["own.py:highest", "attitude"],
        **FLIGHT,
    )
    assert swept.columns["speed_violation"] == pytest.approx([2.0, 2.0])
    assert swept.columns["highest"] == pytest.approx([10, 10], abs=0.1)
    assert (swept.columns["rms_attitude_error"] > 0).all()


def test_a_metric_that_fails_fails_its_flight():
    row = evaluate(metrics=["own.py:fails"]).table[0]
    assert row["failure"].startswith("metric 'own.py:fails': ZeroDivisionError: division by zero")
    assert "own.py:" in row["failure"]


def test_the_limit_of_a_failure_is_an_option():
    given = {"spawn": [1.0, 0, 10.0]}
    assert evaluate(**given).table[0]["failure"] == ""
    assert evaluate(**given, failure_distance=0.5).table[0]["failure"].startswith("lost at t = 0 s")


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"constraints": {"tlit": 1}}, "constraint 'tlit' does not exist. Use one of tilt"),
        ({"constraints": {"tilt": "a"}}, "constraint 'tilt' is 'a'. Give a number."),
        ({"constraints": {"geofence": [1, 2]}}, "Give XMIN,YMIN,ZMIN,XMAX,YMAX,ZMAX."),
        ({"metrics": ["attitdue"]}, "metric 'attitdue' does not exist. Use attitude, rates"),
        ({"metrics": ["own.py:none"]}, "metric 'own.py:none': own.py has no 'none'"),
        ({"metrics": ["own.py:cost", "own:cost"]}, "metric 'cost' is named twice"),
        ({"failure_distance": 0.0}, "failure_distance is 0.0. Give metres, more than 0."),
    ],
)
def test_wrong_criteria_are_bad_input(options, says):
    with pytest.raises(qc.InputError, match=re.escape(says)):
        evaluate(**options)


def test_open_loop_flights_have_no_criteria():
    with pytest.raises(qc.InputError, match="require a controller"):
        qc.sweep(commands=[[0, 470, -470, 470, -470]], metrics=["attitude"], duration=0.1)
