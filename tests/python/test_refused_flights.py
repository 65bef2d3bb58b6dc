"""Exit status of studies: bad input if nothing could fly for that, else a flight that failed."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import quadcore as qc
from quadcore.cli import main

SLOW = "drone_plugin.sim_slow"
SPIRAL = "--reference spiral --duration 0.1 --quiet --no-plots"

pytestmark = pytest.mark.usefixtures("in_empty_folder")


@pytest.fixture(autouse=True)
def flies(in_empty_folder):
    Path("flies.py").write_text(
        "def hover(t, state, reference):\n    return [471, -471, 471, -471]\n"
        "def fails(t, state, reference):\n    raise ValueError('no idea')\n"
        "class Meddles:\n"
        "    def __init__(self, begin):\n        self.begin = begin\n"
        "    def reset(self, simulation):\n        self.simulation = simulation\n"
        "    def __call__(self, t, state, reference):\n"
        "        if t > self.begin:\n            self.simulation.step(1)\n"
        "        return hover(t, state, reference)\n"
        "class Early(Meddles):\n    def __init__(self):\n        super().__init__(-1)\n"
        "class Late(Meddles):\n    def __init__(self):\n        super().__init__(0.0595)\n"
    )


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (
            f"compare quadrotor --vary {SLOW}=1,2 --quiet",
            "2 of 2 flights were refused. The first one: no. 1 (sim_slow 1): ",
        ),
        (
            f"compare quadrotor --vary engine=eigen,ode --controller flies:nope {SPIRAL}",
            "2 of 2 flights were refused. The first one: no. 1 (engine eigen): controller ",
        ),
        (
            f"evaluate --controller nowhere:law {SPIRAL} --seeds 2",
            "2 of 2 flights were refused. The first one: nowhere:law on spiral in eigen, seed 0: ",
        ),
        (
            f"sweep --controller nowhere:law {SPIRAL} --seeds 2",
            "2 of 2 flights were refused. The first one: row 0: controller 'nowhere:law': ",
        ),
    ],
)
def test_flights_that_are_all_refused_are_bad_input(capsys, command, expected):
    assert main(command.split()) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {expected}") and error.count("\n") == 1


@pytest.mark.parametrize(
    "command",
    [
        f"compare quadrotor --vary {SLOW}=1,10 --duration 0.1 --quiet",
        f"evaluate --controller nowhere:law,flies:hover {SPIRAL}",
        f"evaluate --controller nowhere:law,flies:fails {SPIRAL}",
        f"sweep --controller nowhere:law,flies:hover {SPIRAL}",
        f"sweep --controller flies:fails {SPIRAL}",
    ],
)
def test_flights_of_which_some_flew_are_flights_that_failed(capsys, command):
    assert main(command.split()) == 3
    assert " flights failed. The first one: " in capsys.readouterr().err


LATE = "the flight failed at t = 0.060000 s: step(): this simulation is running"


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (f"run quadrotor --controller flies:Late {SPIRAL}", LATE),
        (
            f"compare quadrotor --vary engine=eigen,ode --controller flies:Late {SPIRAL}",
            f"2 of 2 flights failed. The first one: no. 1 (engine eigen): {LATE}",
        ),
        (
            f"compare quadrotor --against 2 --vary engine=eigen,ode --controller flies:Late "
            f"{SPIRAL}",
            f"baseline no. 2 failed: {LATE}",
        ),
        (
            f"evaluate --controller flies:Late {SPIRAL} --privileged --seeds 2",
            "2 of 2 flights failed. The first one: flies:Late (privileged) on spiral in eigen, "
            f"seed 0: {LATE}",
        ),
        (
            f"sweep --controller flies:Late {SPIRAL} --privileged --seeds 2",
            f"2 of 2 flights failed. The first one: row 0: {LATE}",
        ),
    ],
)
def test_bad_input_that_ends_a_flight_under_way_is_a_flight_that_failed(capsys, command, expected):
    assert main(command.split()) == 3
    error = capsys.readouterr().err
    assert error.startswith(f"error: {expected}") and error.count("\n") == 1
    assert main(command.replace("Late", "Early").split()) == 2  # it never flew


def test_a_reference_that_is_none_later_ends_a_flight_that_had_begun():
    hover = qc.references.hover(height=10)
    options = {"controller": "pd", "duration": 0.1, "processes": 1}
    for begin, refused in ((-1, 2), (0.0595, 0)):
        found = qc.compare(
            "quadrotor",
            {"engine": ["eigen", "ode"]},
            reference=lambda t, begin=begin: None if t > begin else hover(t),
            spawn=(0, 0, 10),
            **options,
        )
        assert all(found.table["failure"]) and found.refused == refused, found.table["failure"]


@pytest.mark.parametrize(
    ("controllers", "status", "reasons"),
    [
        ("nowhere:law", 2, ["refused: controller 'nowhere:law'"] * 2),
        ("flies:Late", 3, [LATE] * 2),
        ("flies:Late,nowhere:law", 3, [LATE] * 2 + ["refused: controller 'nowhere:law'"] * 2),
    ],
)
def test_a_sweep_that_goes_on_with_what_is_there_ends_as_it_did(
    capsys, controllers, status, reasons
):
    command = f"sweep --controller {controllers} {SPIRAL} --privileged --seeds 2 --out out".split()
    assert main(command) == status
    expected, table = capsys.readouterr().err, Path("out/table.csv").read_bytes()
    with open("out/table.csv", newline="") as stream:
        failures = [row["failure"] for row in csv.DictReader(stream)]
    assert [why[: len(begin)] for why, begin in zip(failures, reasons)] == reasons
    for kept in (len(reasons), len(reasons) - 1):
        Path("out/table.csv").write_bytes(b"".join(table.splitlines(keepends=True)[: 1 + kept]))
        assert main([*command, "--resume"]) == status
        assert capsys.readouterr().err == expected
        assert Path("out/table.csv").read_bytes() == table
