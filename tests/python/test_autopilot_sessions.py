"""A recorded flight of an autopilot is repeated without its program."""

import gzip
from pathlib import Path

import pytest
from autopilot_files import nothing_remains, write_stack  # noqa: F401
from processes import run_command, run_refused

DATA = Path(__file__).parents[1] / "data"
FLIGHT = ["run", "iris", "--engine", "eigen", "--dt", "0.001", "--duration", "0.3"]


@pytest.fixture
def session(tmp_path):
    path, log = tmp_path / "session.qcs", tmp_path / "log.csv"
    stack = write_stack(tmp_path)
    done = run_command(
        *[*FLIGHT, "--controller", str(stack), "--reference", "step:dx=1,time=0.1"],
        *["--record", str(path), "--log", str(log), "--quiet"],
    )
    assert done.returncode == 0, done.stderr
    names, *rows = (row.split(",") for row in log.read_text().splitlines())
    last = dict(zip(names, map(float, rows[-1])))
    assert last["controller.armed"] == last["controller.arming_switch"] == 1
    assert 0.7 < last["controller.output1"] < 0.9 and last["controller.pitch"] > 0
    stack.unlink()
    return path


def test_a_real_flight_of_betaflight_is_repeated_bit_for_bit():
    """Recorded from Betaflight 301d01a in the strict lockstep: 3 s at 1 kHz, a step of 1 m."""
    done = run_command("autopilot", "replay", str(DATA / "betaflight_301d01a.qcs"))
    assert "the flight is bit-identical to the recorded one" in done.stdout, done.stderr


def test_a_session_is_repeated_without_the_program(session):
    done = run_command("autopilot", "replay", str(session))
    assert done.returncode == 0 and "bit-identical" in done.stdout, done.stderr


def test_a_flight_that_differs_is_found_with_its_time(session, tmp_path):
    content = gzip.decompress(session.read_bytes())
    other = tmp_path / "other.qcs"
    other.write_bytes(gzip.compress(content.replace(b"step:dx=1", b"step:dx=2")))
    done = run_command("autopilot", "replay", str(other))
    assert done.returncode == 3
    assert "error: the flight failed at t = 0.1" in done.stderr
    assert "the flight differs from" in done.stderr


def test_damaged_sessions_are_one_line(session, tmp_path):
    whole = session.read_bytes()
    content = gzip.decompress(whole)
    cases = [b"", b"text", whole[: len(whole) // 2], gzip.compress(content[:-3])]
    cases.append(gzip.compress(b"[]\n"))
    for i, case in enumerate(cases):
        path = tmp_path / f"{i}.qcs"
        path.write_bytes(case)
        assert "is no whole session. Record it again." in run_refused(
            "autopilot", "replay", str(path)
        )


def test_only_autopilots_are_recorded(tmp_path):
    assert "--record: needs an autopilot" in run_refused(
        *FLIGHT, "--controller", "geometric", "--record", str(tmp_path / "s.qcs")
    )
