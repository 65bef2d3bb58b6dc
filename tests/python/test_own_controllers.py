"""Controllers of one's own in an evaluation: each flight anew, faults are rows."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest
from evaluations import FLY, evaluate, rows
from test_guided_runs import OWN

import quadcore as qc
from quadcore.cli import main
from quadcore.control import references
from quadcore.studies.evaluate import margins

OWN_MORE = """
class Never(Hover):
    def __call__(self, t, state, reference):
        while t > 0.05:
            try:
                pass
            except Exception:
                pass
        return self.speeds
class Dies(Hover):
    def __call__(self, t, state, reference):
        import os
        os._exit(3)
class Leaves(Hover):
    def __call__(self, t, state, reference):
        raise SystemExit
class Cancels(Hover):
    def __call__(self, t, state, reference):
        raise BaseException("cancelled")
class Waits(Hover):
    def __init__(self):
        while True:
            pass
flights = []
def remembers(t, state, reference):
    if t == 0:
        flights.append(t)
    return [471 + len(flights), -471, 471, -471]
class Counts(Hover):
    calls = 0
    def __call__(self, t, state, reference):
        self.calls += 1
        if self.calls > 101:
            raise ValueError("another flight's calls")
        return self.speeds
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN + OWN_MORE)
    monkeypatch.delitem(sys.modules, "own", raising=False)


def test_objects_and_functions_are_evaluated_each_flight_anew():
    class Counting:
        rate = 100
        calls = 0

        def __call__(self, t, state, reference):
            self.calls += 1
            assert self.calls <= 50
            return [471, -471, 471, -471]

    found = evaluate([Counting()], "hover", seeds=3, duration=0.5, processes=1)
    assert [row["failure"] for row in found.table] == ["", "", ""]
    assert found.table[0]["controller"] == "Counting"


def test_a_class_in_the_place_of_its_instance_is_refused_with_a_remedy():
    class My:
        def __call__(self, t, state, reference):
            return [471, -471, 471, -471]

    says = r"controller is the class My. Give an instance: My\(\)"
    with pytest.raises(qc.InputError, match=says):
        evaluate([My], ["hover"])
    with pytest.raises(qc.InputError, match=says):
        qc.Simulation("quadrotor", "eigen").run(0.1, controller=My)


def test_faults_of_a_controller_are_rows_and_the_other_flights_finish(capsys):
    own = ["Raises", "Nan", "Short", "Wrong", "Asks", "Nope", "Never", "Dies", "Counts"]
    own += ["Leaves", "Cancels", "Waits"]
    text = ",".join(["pd", "nomodule:X", *(f"own:{name}" for name in own)])
    command = [*FLY, "--controller", text, "--reference", "hover", "--seeds", "2"]
    assert main([*command, "--time-limit", "2", "--out", "out", "--no-plots", "--quiet"]) == 3
    error = capsys.readouterr().err.splitlines()
    assert len(error) == 1
    assert "24 of 28 flights failed. The first one: nomodule:X on hover in eigen" in error[0]
    failures = {row["controller"]: row["failure"] for row in rows()}
    for name, says in {
        "pd": "",
        "own:Counts": "",
        "nomodule:X": "there is no module 'nomodule'",
        "own:Raises": "ValueError: no idea",
        "own:Nan": "rotor 1 is not a finite number",
        "own:Short": "has 2 rotor speeds. Return 4",
        "own:Wrong": "cannot be called as controller(t, state, reference)",
        "own:Asks": "missing 1 required positional argument",
        "own:Nope": "module 'own' has no 'Nope'",
        "own:Never": "not done within the time limit of 2 s",
        "own:Dies": "status 3",
        "own:Leaves": "controller: SystemExit",
        "own:Cancels": "controller: BaseException: cancelled",
        "own:Waits": "not done within the time limit of 2 s",
    }.items():
        assert says in failures[name] if says else failures[name] == "", name


def test_the_time_limit_holds_for_the_mathematical_model_too():
    """Which holds interrupts back while it takes a step."""
    found = evaluate("pd", "hover", engines="lagrange", duration=100, time_limit=0.5)
    assert found.table[0]["failure"] == "not done within the time limit of 0.5 s"


@pytest.mark.parametrize("options", [{"seeds": 3}, {"margins": True}])
def test_what_a_module_remembers_of_a_flight_no_other_flight_knows(options, monkeypatch):
    """Whatever the number of processes: each flight is the first of its module."""
    monkeypatch.setattr(margins, "LARGEST_DELAY", 0.004)  # fewer flights of each kind
    monkeypatch.setattr(margins, "_GAINS", 6)
    monkeypatch.setattr(margins, "_SAMPLES", 2)
    several = [
        evaluate("own:remembers", "hover", duration=0.05, processes=n, **options) for n in (1, 2)
    ]
    assert str(several[0][:4]) == str(several[1][:4])
    assert len({row["max_position"] for row in several[0].table}) == 1


def test_what_a_function_or_a_reference_of_ones_own_remembers_stays_in_its_flight():
    calls, places = [], []

    def controller(t, state, reference):
        calls.append(t)
        return [471 + len(calls), -471, 471, -471]

    def place(t):  # is asked for the log, too, whenever rows of that are handed over
        places.append(t)
        return references.hover()(t)

    found = evaluate([controller], [place], seeds=3, duration=0.1, processes=1)
    assert len({row["max_position"] for row in found.table}) == 1
    assert not calls and not places


def test_a_controller_that_leaves_the_program_ends_its_flight_alone(capsys):
    command = ["run", "quadrotor", "--engine", "eigen", "--controller"]
    assert main([*command, "own:Leaves", "--quiet"]) == 3
    assert "the flight failed at t = 0.000000 s: controller: SystemExit" in capsys.readouterr().err
    Path("quits.py").write_text("import sys\nsys.exit()\n")
    assert main([*command, "quits:Law", "--quiet"]) == 2
    assert "error: controller 'quits:Law': SystemExit" in capsys.readouterr().err


def test_a_controller_that_returns_nothing_fails_its_first_flight_with_status_3(capsys):
    Path("forgot.py").write_text("def law(t, state, reference):\n    speeds = [471] * 4\n")
    command = ["run", "quadrotor", "--engine", "eigen", "--controller", "forgot:law", "--quiet"]
    assert main(command) == 3
    assert capsys.readouterr().err.startswith(
        "error: the flight failed at t = 0.000000 s: the controller returned None: command is "
        "not a 1-dimensional array of numbers. Return 4 rotor speeds in rad/s."
    )


def test_invalid_python_is_reported_with_its_line(capsys):
    Path("half.py").write_text("x = 1\ndef f(:\n")
    assert main(["run", "quadrotor", "--controller", "half:f", "--quiet"]) == 2
    error = capsys.readouterr().err
    assert "error: controller 'half:f': SyntaxError: " in error and "half.py:2)" in error


def test_a_missing_module_of_a_package_is_reported_as_missing(capsys):
    assert main(["run", "quadrotor", "--controller", "no.such:Law", "--quiet"]) == 2
    assert "there is no module 'no.such' here or on PYTHONPATH" in capsys.readouterr().err


def test_the_duration_of_a_controllers_calls_is_reported():
    def slow(t, state, reference):
        time.sleep(0.002)
        return [471, -471, 471, -471]

    found = evaluate(["pd", slow], "hover", duration=0.1)
    controller, own = found.outcomes
    assert controller.call < 0.002 <= own.call <= own.slow_call
    assert own.updates == 50
