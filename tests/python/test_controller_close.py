"""A controller is closed after every flight, however the flight ends."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import time
from dataclasses import replace

import numpy as np
import pytest
from flights import HOVER, quadrotor

import quadcore as qc
from quadcore.studies.grouped_flights import fly_group

HOVERING = qc.references.hover()


class Recorder:
    """Hovers, and records the order of its calls."""

    def __init__(self, fault=None, at=0.004):
        self.calls = []
        self.fault, self.at = fault, at

    def reset(self, simulation):
        self.calls.append("reset")

    def close(self):
        self.calls.append("close")

    def __call__(self, t, state, reference):
        if self.fault is not None and t >= self.at:
            raise self.fault
        return HOVER


@pytest.mark.parametrize(
    ("fault", "raised"),
    [
        (None, None),
        (ValueError("broken"), ValueError),
        (SystemExit(3), SystemExit),
        (KeyboardInterrupt(), KeyboardInterrupt),
    ],
)
def test_a_controller_is_closed_once_after_each_flight(fault, raised):
    controller = Recorder(fault)
    simulation = quadrotor()
    for _ in range(2):
        if raised is None:
            simulation.run(0.01, controller=controller)
        else:
            simulation.reset()
            with pytest.raises(raised):
                simulation.run(0.01, controller=controller)
    assert controller.calls == ["reset", "close"] * 2


def fail_in_reset(controller):
    def fail(simulation):
        controller.calls.append("reset")
        raise RuntimeError("no autopilot")

    controller.reset = fail
    return controller


def test_a_controller_that_fails_in_reset_is_closed():
    controller = fail_in_reset(Recorder())
    with pytest.raises(RuntimeError, match="no autopilot"):
        quadrotor().run(0.01, controller=controller)
    assert controller.calls == ["reset", "close"]


def test_an_error_in_close_ends_a_good_flight_and_is_a_warning_after_a_failure():
    def fail():
        raise RuntimeError("the socket is gone")

    controller = Recorder()
    controller.close = fail
    with pytest.raises(RuntimeError, match="the socket is gone"):
        quadrotor().run(0.01, controller=controller)
    controller.fault = ValueError("broken")
    warned = pytest.warns(qc.QuadcoreWarning, match=r"its close\(\) failed: RuntimeError: the soc")
    with warned, pytest.raises(ValueError, match="broken"):
        quadrotor().run(0.01, controller=controller)


class VectorRecorder(Recorder):
    vectorized = True

    def __call__(self, t, state, reference):
        return np.tile(super().__call__(t, state, reference), (len(state.position), 1))


@pytest.mark.parametrize(
    ("make", "calls"),
    [
        (lambda: [VectorRecorder()], ["reset", "close"]),
        (lambda: [VectorRecorder(ValueError("broken"))], ["reset", "close"]),
        (lambda: [fail_in_reset(VectorRecorder())], ["reset", "close"]),
        (lambda: [Recorder()], []),
        (lambda: [VectorRecorder() for _ in range(3)], []),
    ],
    ids=["vectorized", "failing", "failing in reset", "of one vehicle", "three"],
)
def test_a_batch_closes_each_controller_that_it_resets(make, calls):
    controllers = make()
    batch = qc.BatchSimulation("quadrotor", 3)
    given = controllers if len(controllers) > 1 else controllers[0]
    with contextlib.suppress(qc.InputError, ValueError, RuntimeError):
        batch.run(0.01, controller=given, reference="hover")
    assert [controller.calls for controller in controllers] == [calls] * len(controllers)


@pytest.mark.parametrize(
    "make", [lambda: fail_in_reset(VectorRecorder()), VectorRecorder], ids=["fails", "flies"]
)
def test_a_group_of_seeds_closes_the_controller_that_it_resets(make):
    controller = make()
    plan = qc.FlightPlan.of(
        "quadrotor", engine="eigen", duration=0.01, controller=controller, reference=HOVERING
    )
    fly_group([lambda: plan, lambda: replace(plan, seed=1)], 100)
    assert controller.calls == ["reset", "close"]


class Spinner:
    """Starts a process, never returns from its second call, and ends the process in close."""

    def reset(self, simulation):
        self.process = subprocess.Popen(["sleep", "1000"])
        self.hover = np.asarray(simulation.hover_speed)

    def close(self):
        time.sleep(1.2)  # longer than the time between two alarms of the time limit
        self.process.terminate()
        self.process.wait()
        with open(os.environ["CLOSED"], "a") as file:
            file.write(f"{self.process.pid}\n")

    def __call__(self, t, state, reference):
        while t > 0:
            pass
        return self.hover


def test_the_time_limit_leaves_no_process_of_a_controller_behind(tmp_path, monkeypatch):
    monkeypatch.setenv("CLOSED", str(tmp_path / "closed"))
    found = qc.evaluate(Spinner(), "hover", duration=0.1, seeds=2, time_limit=3, processes=2)
    assert all("time limit" in row["failure"] for row in found.table)
    pids = (tmp_path / "closed").read_text().split()
    assert len(pids) == 2
    for pid in map(int, pids):
        with pytest.raises(ProcessLookupError):
            os.kill(pid, signal.SIGCONT)


class Fixed(Recorder):
    rate = 250.0
    fixed_rate = True


def test_a_fixed_rate_is_kept_and_another_is_refused():
    found = qc.evaluate(Fixed(), "hover", duration=0.1, controller_rate=250)
    assert not found.table[0]["failure"]
    found = qc.evaluate(Fixed(), "hover", duration=0.1, controller_rate=500)
    assert "its rate is fixed at 250 1/s. Do not set another." in found.table[0]["failure"]
