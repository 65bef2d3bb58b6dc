"""Pages of tune, fit and predict: verdict, tables, and flights that agree with the results."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from test_player import content_of

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.fit.output import describe_residual

SPEEDS = "t,w1,w2,w3,w4\n0,480,-480,480,-480\n0.5,490,-470,490,-470\n1,470,-480,470,-480\n"


@pytest.fixture(autouse=True)
def in_folder(tmp_path, monkeypatch):
    """Run every test in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def names_of(page):
    return [flight["name"] for flight in content_of(page)["flights"]]


def test_the_page_of_a_tuning_flies_the_gains_that_it_lists():
    pytest.importorskip("cma")
    words = "tune pd:kp_xy=0.5,kd_xy=0.5 --only kp_xy,kd_xy --reference step --hold-out circle"
    flight = "--duration 2 --budget 6 --xacro sim_slow:=1 --quiet --out out"
    assert main([*words.split(), *flight.split()]) == 0
    page = Path("out/report.html").read_text()
    assert names_of(page) == ["start", "tuned"] and "Tuning reduces the mean RMS" in page
    tuned = yaml.safe_load(Path("out/gains.yaml").read_text())
    errors = []
    for number in (1, 2):
        log = qc.Log.of_file(f"out/logs/{number}.csv")
        wanted = np.column_stack([log.topics["reference"][axis] for axis in "xyz"])
        errors.append(np.sqrt(np.mean(np.sum((log.position - wanted) ** 2, axis=1))))
    held_out = tuned["history"]["held_out"]["circle"]
    assert errors[1] == pytest.approx(held_out, rel=1e-3) and errors[1] < errors[0]
    assert f"{held_out:.4g}" in page
    assert main(["play", "out", "-o", "page.html", "--quiet"]) == 0


def test_the_verdict_of_a_fit_states_whether_the_residual_is_smaller():
    better = describe_residual("position", "m", (0.02, 0.01, 0.015))
    assert better == (
        "The fit reduces the RMS residual of the position: 0.02 m with the start values, "
        "0.01 m with the fitted values, 0.015 m in the held-out parts"
    )
    worse = describe_residual("position", "m", (0.01, 0.02, float("nan")))
    assert worse == (
        "The fit does not reduce the RMS residual of the position: 0.01 m with the start values, "
        "0.02 m with the fitted values"
    )


def test_the_page_of_a_fit_shows_that_the_fitted_model_follows_the_measured_flight():
    Path("speeds.csv").write_text(SPEEDS)
    thrust = "drone_plugin.rotorThrustCoeff"
    flight = ["quadrotor", "--engine", "eigen", "--xacro", "sim_slow:=1"]
    flown = ["--commands", "speeds.csv", "--duration", "3", "--log-every", "10", "--quiet"]
    assert main(["run", *flight, *flown, "--set", f"{thrust}=1.2e-5", "--log", "log.csv"]) == 0
    words = ["fit", *flight, "--log", "log.csv", "--commands", "speeds.csv", "--free", thrust]
    assert main([*words, "--quiet", "--out", "out"]) == 0
    page = Path("out/report.html").read_text()
    assert names_of(page) == ["measured", "fitted model", "initial model"]
    assert "The fit reduces the RMS residual of the position" in page and thrust in page
    measured, fitted, initial = (qc.Log.of_file(f"out/logs/{i}.csv") for i in (1, 2, 3))
    log = qc.Log.of_file("log.csv")
    rows = np.searchsorted(log.time, measured.time - 1e-9)
    assert np.allclose(measured.position, log.position[rows]) and len(rows) > 200
    assert np.abs(fitted.position - measured.position).max() < 1e-6
    assert np.abs(fitted.orientation - measured.orientation).max() < 1e-6
    assert np.abs(initial.position - measured.position).max() > 1e-2
    assert qc.read_model("out/fitted.urdf").name == "quadrotor"
    assert main(["play", "out", "-o", "page.html", "--quiet"]) == 0
