"""examples/estimator: the geometric controller with measured states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.cli import main

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "estimator"


@pytest.fixture
def here(monkeypatch):
    monkeypatch.chdir(FOLDER)
    monkeypatch.syspath_prepend(str(FOLDER))


def simulation(seed, engine="eigen", **parameters):
    return qc.FlightPlan.of(
        "quadrotor",
        engine=engine,
        scenario="sensors.yaml",
        xacro_args={"sim_slow": 1},
        parameters=parameters,
        seed=seed,
    ).simulation()


class Watched:
    """A controller and the errors of its estimate at each call."""

    def __init__(self, controller, flown):
        self.rate, self.observed, self.flown = controller.rate, controller, flown
        self.reset = controller.reset
        self.errors, self.believed = [], []

    def __call__(self, t, state, reference):
        speeds = self.observed(t, state, reference)
        estimate, truth = self.observed.estimate, self.flown.state
        turn = Rotation.from_quat(truth.orientation).inv() * Rotation.from_quat(
            estimate.orientation
        )
        self.errors.append(
            np.concatenate(
                [
                    estimate.position - truth.position,
                    estimate.linear_velocity - truth.linear_velocity,
                    turn.as_rotvec(),
                ]
            )
        )
        self.believed.append(estimate.deviations[:9])
        return speeds


def fly(reference, seed, seconds=10, **options):
    from estimated import Geometric

    flown = simulation(seed, **options)
    controller = Watched(Geometric(), flown)
    log = flown.run(
        seconds, controller=controller, reference=reference, on_reference=True, log_every=10,
    )  # fmt: skip
    wanted = np.array([reference(t).position for t in log.time])
    away = np.linalg.norm(log.position - wanted, axis=1)
    late = np.array(controller.errors)[len(controller.errors) // 4 :]
    return away, late, np.array(controller.believed)[-len(late) :]


@pytest.mark.parametrize("shape", ["hover", "spiral"])
def test_the_controller_flies_within_decimetres_though_the_receiver_errs_by_metres(shape, here):
    away, late, believed = fly(getattr(qc.references, shape)(), seed=1)
    rms = np.sqrt(np.mean(late**2, axis=0))
    print(shape, "away", away.max(), np.sqrt(np.mean(away**2)), "errors", rms)
    assert 0.01 < away.max() < 0.4
    assert rms[:3].max() < 0.25 and rms[3:6].max() < 0.08 and rms[6:].max() < 0.01
    # Its errors are what it believes them to be.
    assert 0.3 < np.sqrt(np.mean((late / believed) ** 2)) < 1.6


def test_nothing_is_taken_from_the_odometry_after_the_start(here):
    hover = qc.references.hover()
    quiet, noisy = (
        fly(hover, seed=2, seconds=1, **{"odometry.linearVelocityWalk": walk})[0]
        for walk in (0, 50)
    )
    assert quiet.tobytes() == noisy.tobytes()


def test_it_is_one_more_row_of_an_evaluation(here, tmp_path):
    arguments = ["--scenario", "sensors.yaml", "--engine", "eigen", "--xacro", "sim_slow:=1"]
    controllers_given = ["--controller", "geometric,estimated:Geometric", "--reference", "hover"]
    out = ["--duration", "2", "--out", str(tmp_path / "out"), "--quiet"]
    assert main(["evaluate", *controllers_given, *arguments, *out]) == 0
    rows = (tmp_path / "out" / "table.csv").read_text().splitlines()
    assert len(rows) == 3 and "estimated:Geometric" in rows[2]


def test_without_sensors_it_says_what_it_needs(here, capsys):
    arguments = ["quadrotor", "--controller", "estimated:Geometric", "--engine", "eigen"]
    assert main(["run", *arguments, "--duration", "1", "--quiet"]) == 2
    assert "Add libimu_plugin.so, or use --scenario sensors.yaml" in capsys.readouterr().err
