"""Strict lockstep: the clock of an unmodified program stands still between two ticks."""

import subprocess
from pathlib import Path

import pytest
from autopilot_files import nothing_remains  # noqa: F401
from processes import QUADCORE, run_command

FLIGHT = ["run", "iris", "--engine", "eigen", "--dt", "0.001", "--reference", "hover", "--quiet"]


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    built = tmp_path_factory.mktemp("stand_in") / "stand_in"
    source = Path(__file__).with_name("lockstep_stand_in.cpp")
    subprocess.run(["g++", "-std=c++17", "-o", built, source, "-lpthread"], check=True)
    return built


def write_stack(folder, program, more=""):
    path = folder / "strict.yaml"
    path.write_text(f"autopilot: betaflight\nprogram: {program}\nhold: 1.6\n{more}")
    return str(path)


def test_flights_are_bit_identical_also_side_by_side(tmp_path, program):
    """The program has fixed ports, and its outputs contain its clock."""
    stack = write_stack(tmp_path, program)
    command = [*QUADCORE, *FLIGHT, "--duration", "0.5", "--controller", stack, "--log"]
    logs = [tmp_path / f"{name}.csv" for name in "abc"]
    flights = [
        subprocess.Popen([*command, log], stderr=subprocess.PIPE, text=True) for log in logs[:2]
    ]
    assert [flight.communicate()[1].count("error") for flight in flights] == [0, 0]
    run_command(*command[len(QUADCORE) :], str(logs[2]))
    assert logs[0].read_bytes() == logs[1].read_bytes() == logs[2].read_bytes()
    heights = [float(row.split(",")[3]) for row in logs[0].read_text().splitlines()[1:]]
    assert len(heights) == 501 and heights[-1] > heights[0]  # the outputs reach the motors


def test_a_program_that_dies_ends_the_flight_with_its_time(tmp_path, program):
    stack = write_stack(tmp_path, program, "arguments: [1.85]\n")
    done = run_command(*FLIGHT, "--duration", "1", "--controller", stack)
    assert done.returncode == 3
    assert "error: the flight failed at t = 0.25" in done.stderr
    assert "the autopilot ended (signal SIGABRT). It printed nothing." in done.stderr


def test_lockstep_has_two_modes(tmp_path, program):
    done = run_command(*FLIGHT, "--controller", write_stack(tmp_path, program, "lockstep: loose\n"))
    assert done.returncode == 2
    assert "strict.yaml:4: lockstep is loose. Use strict or plain." in done.stderr
