"""The numerical error of the plant, from a flight at half the step."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from evaluations import FLY

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.evaluate.step_error import measure_step_error
from quadcore.studies.options import EvaluateOptions


def plan_of(controllers="pd", engine="eigen", **options):
    given = {"duration": 1.0, "xacro_args": {"sim_slow": 1}, **options}
    return Plan(controllers, "circle", [engine], ["quadrotor"], {}, EvaluateOptions(**given))


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_the_error_is_the_change_of_the_flight_at_half_the_step(engine):
    found = measure_step_error(plan_of(engine=engine))
    simulations = [
        qc.Simulation("quadrotor", engine, dt=dt, xacro_args={"sim_slow": 1}) for dt in (1e-3, 5e-4)
    ]
    flights = [
        simulation.run(1.0, controller="pd", reference="circle", on_reference=True, log_every=every)
        for simulation, every in zip(simulations, (10, 20))
    ]
    change = np.linalg.norm(flights[0].position - flights[1].position, axis=1).max()
    assert found.position == pytest.approx(change, rel=1e-9)
    assert f"{change:.2g} m" in found.describe() and "pd (quadrotor" in found.flight


def test_the_error_of_the_exact_engine_is_far_below_that_of_gazebo():
    exact, gazebo = (measure_step_error(plan_of(engine=name)) for name in ("eigen", "gazebo11"))
    assert exact.position < 0.1 * gazebo.position


def test_a_random_flight_and_one_without_plugins_have_none():
    noisy = measure_step_error(plan_of(parameters={"odometry.positionNoise": 1e-4}))
    assert noisy.position is None and "not measured" in noisy.describe()
    assert measure_step_error(plan_of(engine="lagrange")) is None


def test_a_built_in_controller_replaces_those_of_users():
    own = measure_step_error(plan_of({"own": lambda t, state, reference: [0] * 4}))
    assert own.position == measure_step_error(plan_of("geometric")).position
    assert own.flight == ("own (quadrotor, eigen) on circle, with geometric as its controller")

    def fail(t):
        raise ValueError(t)

    plan = Plan("pd", {"bad": fail}, ["eigen"], ["quadrotor"], {}, EvaluateOptions(duration=1.0))
    assert measure_step_error(plan).position is None


def test_pages_of_sweeps_searches_and_benchmarks_contain_the_error(in_empty_folder):
    flight = ["--reference", "circle", "--xacro", "sim_slow:=1", "--duration", "0.3", "--quiet"]
    flight += ["--out"]
    sweep = ["sweep", "--controller", "pd", "--vary", "controller.rate=250,500", *flight, "swept"]
    tune = ["tune", "geometric", "--budget", "1", "--hold-out", "hover", *flight, "tuned"]
    benchmark = ["benchmark", "--controller", "geometric", "--vehicle", "crazyflie"]
    benchmark += ["--category", "delay", "--quiet", "--out", "benchmark"]
    for words in (sweep, [*tune, "-o", "gains.yaml"], benchmark):
        assert main(words) == 0
    named = {
        "swept": "row 1, median",
        "tuned": "hover",
        "benchmark": "geometric (crazyflie, eigen)",
    }
    for folder, flight in named.items():
        page = Path(folder, "report.html").read_text()
        assert re.search(rf"Numerical error of the plant: .* of {re.escape(flight)}", page), folder


def test_flights_beyond_the_time_limit_have_none():
    slow = measure_step_error(plan_of(engine="gazebo11", duration=10.0, time_limit=0.01))
    assert slow.position is None and "exceeds the time limit" in slow.describe()


def test_an_interrupt_keeps_the_tables(in_empty_folder, monkeypatch, capsys):
    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("quadcore.studies.evaluate.output.measure_step_error", interrupt)
    command = [*FLY, "--controller", "pd", "--reference", "hover", "--no-plots", "--quiet"]
    assert main([*command, "--out", "out"]) == 130
    assert "pd,hover" in Path("out/table.csv").read_text()
    assert json.loads(Path("out/evaluation.json").read_text())["step_error"] is None


def test_page_and_json_contain_the_error(in_empty_folder):
    command = [*FLY, "--controller", "pd", "--reference", "hover", "--no-plots", "--quiet"]
    assert main([*command, "--out", "out"]) == 0
    content = json.loads(Path("out/evaluation.json").read_text())["step_error"]
    assert content["position"] < 1e-9 and content["step"] == 1e-3
    assert "Numerical error of the plant" in Path("out/report.html").read_text()
