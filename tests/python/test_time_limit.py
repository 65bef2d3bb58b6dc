"""The wall-clock limit of code that holds the interpreter and ends with its process."""

from __future__ import annotations

import ctypes
import os
import time

import pytest

import quadcore as qc
from quadcore.studies import time_limit
from quadcore.studies.executor import run_cases


def run(function, cases=(0,)):
    """Run some cases in one process after the other; returns the results as texts."""
    found = {}
    run_cases(function, cases, lambda i, result: found.update({i: str(result)}), processes=1)
    return [found[i] for i in range(len(cases))]


def hold_interpreter(case):
    with time_limit.time_limit(0.2):
        if case:
            ctypes.PyDLL(None).sleep(30)
    return "done"


def test_a_process_that_holds_the_interpreter_ends_with_the_limit_as_its_reason(monkeypatch):
    monkeypatch.setattr(time_limit, "_PATIENCE", 0.2)
    late = "not done within the time limit of 0.2 s"
    assert run(hold_interpreter, [0, 1, 0, 1]) == ["done", late, "done", late]


def test_the_limit_holds_in_the_first_process_too():
    with pytest.raises(
        qc.FlightError, match=r"within the time limit of 0\.1 s"
    ), time_limit.time_limit(0.1):
        time.sleep(5)


def test_a_process_that_ends_itself_with_the_same_status_is_not_late():
    def end(_):
        with time_limit.time_limit(10):
            os._exit(1)

    assert run(end) == ["its process ended with status 1"]
