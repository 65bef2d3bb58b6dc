"""Loop gains measured by injection, against linear loops and loops with a known gain."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.evaluate import loop_responses
from quadcore.studies.evaluate.evaluate import fly_plan
from quadcore.studies.evaluate.linear_loops import make_loops, measure_drag
from quadcore.studies.evaluate.loop_margins import find_margins
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.evaluate.poles import read_gains
from quadcore.studies.options import EvaluateOptions
from quadcore.thesis.chapter2 import Vehicle


@pytest.fixture
def brief(monkeypatch):
    """Shorter flights, which measure from a higher frequency on."""
    monkeypatch.setattr(loop_responses, "_PERIOD", 6.0)
    monkeypatch.setattr(loop_responses, "_SETTLE", 8.0)


def test_margins_of_a_known_loop():
    """L = k e^(-s tau) / s: crossover k, phase margin pi/2 - k tau, delay margin that over k."""
    frequencies = np.geomspace(0.1, 100, 20_000)
    response = 4 * np.exp(-0.1j * frequencies) / (1j * frequencies)
    found = find_margins(frequencies, response)
    assert found.crossover == pytest.approx(4, rel=1e-3)
    assert found.phase_margin == pytest.approx(np.pi / 2 - 0.4, rel=1e-3)
    assert found.delay_margin == pytest.approx((np.pi / 2 - 0.4) / 4, rel=1e-3)
    # The phase is -180 degrees at pi / (2 tau), where the gain is 4 * 2 * tau / pi.
    assert found.gain_high == pytest.approx(np.pi / 0.8, rel=1e-3)
    assert found.gain_low == 0
    # A lag after a double integrator is stable for small gains only; a lead for large ones only.
    s = 1j * frequencies
    found = find_margins(frequencies, 4 * (s + 1) ** 2 / s**3)
    assert found.gain_low == pytest.approx(0.125, rel=1e-2)  # s^3 + 4k (s + 1)^2: 8k > 1
    assert found.gain_high == np.inf


def test_the_measured_loops_are_the_linear_ones(brief):
    options = EvaluateOptions(
        duration=0.1, xacro_args={"sim_slow": 1}, frequency_response=True, controller_rate=500
    )
    plan = Plan("pd", "hover", ["eigen"], ["quadrotor"], {}, options)
    rows = {row["axis"]: row for row in fly_plan(plan).loops}
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    vehicle = Vehicle.of(simulation)
    lag = float(np.mean(vehicle.rotor_inertia)) / vehicle.motor_gain
    gains = read_gains(qc.controllers.pd())
    loops = make_loops(gains, vehicle, measure_drag(simulation), lag)
    for axis, name in (("z", "z"), ("roll", "x, y"), ("pitch", "x, y")):
        row = rows[axis]
        assert row["failure"] == ""
        frequencies = np.array(row["frequencies"])
        measured = row["gain"] * np.exp(1j * np.array(row["phase"]))
        # The command holds for 2 ms, a delay of half of that.
        linear = loops[name].compute_response(frequencies) * np.exp(-1e-3j * frequencies)
        inner = frequencies < 100
        assert np.abs(measured / linear - 1)[inner].max() < 0.05, axis
        assert row["delay_margin"] == pytest.approx(row["linear_delay_margin"], rel=0.02)
        peak = np.abs(1 / (1 + linear)).max()
        assert row["rejection_peak"] == pytest.approx(peak, rel=0.05)
    assert rows["yaw"]["delay_margin"] == pytest.approx(
        rows["yaw"]["linear_delay_margin"], rel=0.05
    )


class Attitude:
    """Height and attitude of a hover, by set points."""

    def reset(self, vehicle):
        self.weight = vehicle.mass * -vehicle.gravity[2]

    def __call__(self, t, state, reference):
        a = 2 * (reference.position - state.position) - 2 * state.linear_velocity
        x, y, z = a + np.array([0, 0, 9.8])
        q = np.array([-y, x, 0, np.hypot(np.hypot(x, y), z) + z])
        return qc.AttitudeThrust(q / np.linalg.norm(q), self.weight * (1 + a[2] / 9.8))


def test_your_own_controller_has_loops_too(brief):
    found = qc.evaluate(
        {"own": Attitude(), "wrong": lambda t, state, reference: [0.0] * 4},
        "hover",
        frequency_response=True,
        duration=0.1,
        xacro_args={"sim_slow": 1},
    )
    own, wrong = found.loops[:4], found.loops[4:]
    assert [row["axis"] for row in own] == ["z", "roll", "pitch", "yaw"]
    # Around the thrust: L = (2 s + 2) / s^2 with motor lag; its crossover is near 2.2 rad/s.
    s = 1j * np.array(own[0]["frequencies"])
    ideal = (2 * s + 2) / s**2
    assert np.abs(own[0]["gain"] / np.abs(ideal) - 1)[np.abs(s) < 5].max() < 0.1
    assert own[0]["crossover"] == pytest.approx(2.2, rel=0.1)
    assert all(row["failure"] for row in wrong)


def test_page_json_and_terminal_have_the_loops(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(loop_responses, "_PERIOD", 2.0)
    monkeypatch.setattr(loop_responses, "_SETTLE", 1.0)
    words = ["evaluate", "--controller", "geometric", "--reference", "hover", "--out", "out"]
    words += ["--frequency-response", "--duration", "0.1", "--xacro", "sim_slow:=1"]
    assert main(words) == 0
    loops = json.loads(Path("out/evaluation.json").read_text())["loops"]
    assert [row["axis"] for row in loops] == ["z", "roll", "pitch", "yaw"]
    assert loops[0]["linear_delay_margin"] is None
    output = capsys.readouterr().out
    page = Path("out/report.html").read_text()
    assert "crossover" in output and "Frequency responses in hover" in page
    assert Path("out/loops.png").exists()
