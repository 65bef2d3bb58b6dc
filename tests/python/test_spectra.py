"""Power spectral densities of angular velocity and commands."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main

WORDS = ["evaluate", "--controller", "geometric", "--reference", "circle", "--duration", "1"]
WORDS += ["--xacro", "sim_slow:=1", "--set", "odometry.positionNoise=0.002"]


class Shaken:
    """Hover with a roll torque that alternates at 7 Hz."""

    def reset(self, vehicle):
        self.hover = qc.controllers.geometric()
        self.hover.reset(vehicle)
        self.share = np.linalg.pinv(vehicle.vehicle.allocation)[:, 1]

    def __call__(self, t, state, reference):
        speeds = self.hover(t, state, reference)
        squares = speeds**2 + 0.02 * self.share * np.sin(2 * np.pi * 7 * t)
        return np.sign(speeds) * np.sqrt(squares)


def test_the_densities_show_a_vibration_and_integrate_to_the_variance():
    given = {"duration": 20.0, "xacro_args": {"sim_slow": 1}}
    found = qc.evaluate(Shaken(), "hover", spectra=True, log_every=5, **given)
    (outcome,) = found.outcomes
    spectra = outcome.spectra
    assert spectra.frequencies[-1] == pytest.approx(100, rel=0.01)
    for density in (spectra.rates, spectra.commands):
        assert spectra.frequencies[density.argmax()] == pytest.approx(7, abs=0.26)
    sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    log = sim.run(20.0, controller=Shaken(), reference="hover", log_every=5)
    variance = log.angular_velocity[200:].var(axis=0).sum()
    width = spectra.frequencies[1]
    assert spectra.rates.sum() * width == pytest.approx(variance, rel=0.1)


def test_spectra_are_drawn_on_request(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main([*WORDS, "--spectra", "--out", "out", "--quiet"]) == 0
    assert Path("out/spectra_1.png").exists()
    assert "Power spectral densities: circle" in Path("out/report.html").read_text()
    assert qc.evaluate("geometric", "circle", duration=0.1).outcomes[0].spectra is None


def test_short_and_failed_flights_have_none():
    given = {"spectra": True, "duration": 0.1, "xacro_args": {"sim_slow": 1}}
    found = qc.evaluate(["geometric", "none.py:None"], "circle", **given)
    assert [outcome.spectra for outcome in found.outcomes] == [None, None]
