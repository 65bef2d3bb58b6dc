"""SIGINT, SIGTERM and SIGHUP end long commands soon, and what was flown is kept."""

from __future__ import annotations

import csv
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from processes import outcomes, script

import quadcore as qc
from quadcore.studies.executor import contain_errors, run_cases
from quadcore.support import interrupts

TRIALS = int(os.environ.get("QUADCORE_TRIALS", "2"))  # moments, of each signal and command
SIGNALS = list(interrupts.SIGNALS)
QUADCORE = [sys.executable, "-m", "quadcore"]
# A fall that never ends: with other drags it diverges after five minutes.
FALL = ["quadrotor", "--engine", "eigen", "--set", "drone_plugin.dragModel=chapter2"]
LONG = 120.0  # s; generous, because waiting costs nothing when things work


def until(condition):
    """Wait for a condition; returns what it gave."""
    give_up = time.monotonic() + LONG
    while time.monotonic() < give_up:
        found = condition()
        if found:
            return found
        time.sleep(0.01)
    raise AssertionError("waited in vain")


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def list_hidden(folder):
    return [name for name in files(folder) if Path(name).name.startswith(".")]


def children(pid):
    """Processes whose parent this is, that have not ended."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                state, parent = (entry / "stat").read_text().rpartition(")")[2].split()[:2]
            except OSError:
                continue
            if int(parent) == pid and state != "Z":
                found.append(int(entry.name))
    return found


def alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def stop_command(process, number):
    """What a command prints that is asked to end."""
    process.send_signal(number)
    _, error = process.communicate(timeout=LONG)
    assert process.returncode == 128 + number, error
    assert error.endswith("interrupted\n") and "Traceback" not in error
    return error


def start_command(*arguments, folder):
    return subprocess.Popen(
        [*QUADCORE, *arguments],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        universal_newlines=True,
    )


@pytest.mark.parametrize("number", SIGNALS)
def test_a_run_ended_at_random_moments_keeps_what_was_flown(number, tmp_path):
    moments = random.Random(int(number))
    for trial in range(TRIALS):
        folder = tmp_path / str(trial)
        folder.mkdir()
        process = start_command(
            *("run", *FALL, "--duration", "100000"),
            *("--log", "log.csv", "--out", "out", "--no-plots"),
            folder=folder,
        )
        until(lambda log=folder / "log.csv": log.exists() and log.stat().st_size > 0)
        time.sleep(moments.uniform(0, 0.3))
        stop_command(process, number)
        assert files(folder) == ["log.csv", "out/log.csv", "out/model.urdf", "out/run.json"]
        table = np.loadtxt(folder / "log.csv", delimiter=",", skiprows=1)
        assert table[:, 0] == pytest.approx(1e-3 * np.arange(len(table)))
        assert (folder / "log.csv").read_bytes() == (folder / "out" / "log.csv").read_bytes()


@pytest.mark.parametrize("number", SIGNALS)
def test_a_comparison_ended_at_random_moments_keeps_what_was_flown(number, tmp_path):
    moments = random.Random(int(number))
    for trial in range(TRIALS):
        folder = tmp_path / str(trial)
        folder.mkdir()
        process = start_command(
            *("compare", *FALL, "--duration", "0.5", "--logs"),
            *("--vary", "motorpid_plugin.kp=1e-4:5e-4:5000", "--jobs", "2", "--out", "out"),
            folder=folder,
        )
        until(lambda logs=folder / "out" / "logs": len(list(logs.glob("[0-9]*"))) > 2)
        time.sleep(moments.uniform(0, 0.3))
        stop_command(process, number)
        assert list_hidden(folder) == []
        with (folder / "out" / "table.csv").open(newline="") as stream:
            rows = list(csv.DictReader(stream))
        flown = [row["number"] for row in rows if row["failure"] == ""]
        kept = [str(int(path.stem)) for path in (folder / "out" / "logs").iterdir()]
        assert set(kept) == set(flown) and len(rows) == 5000
        assert {row["failure"] for row in rows} == {"", "not flown: interrupted"}
        for path in (folder / "out" / "logs").iterdir():
            assert path.read_text().count("\n") == 502


@pytest.mark.parametrize("number", SIGNALS)
def test_a_validation_ended_at_random_moments_keeps_what_was_flown(number, tmp_path):
    """In turn while it flies and while it draws."""
    moments = random.Random(int(number))
    for trial in range(TRIALS):
        out = tmp_path / str(trial)
        drawing = trial % 2 == 1
        process = start_command(
            *("validate", "--drag", "none,profile,all", "--sim-slow", "1,2", "--jobs", "2"),
            *("--engine", "eigen", "--duration", "0.5" if drawing else "200", "--out", str(out)),
            folder=tmp_path,
        )
        until(lambda seen=out / "errors.csv" if drawing else out: seen.exists())
        time.sleep(moments.uniform(0, 0.3))
        stop_command(process, number)
        assert list_hidden(out) == []
        if not drawing and files(out) == []:
            continue  # before the first flight
        tables = ["chains.csv", "commands.csv", "errors.csv", "report.html", "validation.json"]
        listed = ["run.json"] + ["models/1.urdf"] * (out / "models").exists()
        others = [name for name in files(out) if not name.endswith(".png")]
        assert [name for name in others if not name.startswith("logs/")] == sorted(
            [*tables, *listed]
        )
        with (out / "errors.csv").open(newline="") as stream:
            rows = list(csv.DictReader(stream))
        assert [(row["sim_slow"], row["drag"]) for row in rows] == [
            (slow, drag) for slow in ("1.0", "2.0") for drag in ("none", "profile", "all")
        ]
        for row in rows:
            assert row["failure"] or float(row["max_distance"]) >= 0
            assert not (drawing and row["failure"])
        found = json.loads((out / "validation.json").read_text())
        assert [row["failure"] for row in found["errors"]] == [row["failure"] for row in rows]
        page = (out / "report.html").read_text()
        assert page.endswith("</html>")
        pictures = list(out.glob("*.png"))
        assert page.count('<figure class="plot"><svg ') == len(pictures)
        for picture in pictures:
            assert picture.read_bytes().endswith(b"IEND\xaeB`\x82")


def test_processes_end_with_a_parent_that_is_killed(tmp_path):
    process = start_command(
        *("compare", *FALL, "--duration", "1e5", "--jobs", "2", "--log-every", "1000"),
        *("--vary", "motorpid_plugin.kp=1e-4:5e-4:3"),
        folder=tmp_path,
    )
    workers = until(lambda: children(process.pid))
    process.kill()
    process.communicate(timeout=LONG)
    until(lambda: not any(alive(pid) for pid in workers))


def test_nohup_keeps_a_flight_in_the_air(tmp_path):
    process = subprocess.Popen(
        [*QUADCORE, "run", *FALL, "--duration", "1e5", "--log", "l.csv"],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        universal_newlines=True,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )
    log = tmp_path / "l.csv"
    until(lambda: log.exists() and log.stat().st_size > 0)
    process.send_signal(signal.SIGHUP)
    size = log.stat().st_size
    until(lambda: log.stat().st_size > size)
    stop_command(process, signal.SIGTERM)


def test_a_process_ended_by_a_signal_without_a_name_is_a_case_that_failed():
    def die(number):
        if number == 1:
            os.kill(os.getpid(), 40)
        return number

    results = outcomes(die, range(3), 2)
    assert (results[0], results[2]) == (0, 2)
    assert str(results[1]) == "its process was ended by signal 40"


def test_an_interrupt_while_an_outcome_is_taken_loses_none_of_the_others(tmp_path):
    taken = []

    def write_file(number):
        (tmp_path / str(number)).touch()
        return number

    def take(index, outcome):
        if not taken:
            until(lambda: len(files(tmp_path)) > 1)  # one more waits to be taken
            os.kill(os.getpid(), signal.SIGTERM)
        taken.append((index, outcome))

    with pytest.raises(interrupts.Interrupted), interrupts.raise_on_signals():
        run_cases(lambda number: number, range(1000), take, 2, write_file)
    assert sorted(str(number) for number, _ in taken) == files(tmp_path)
    assert all(outcome == index for index, outcome in taken) and 1 < len(taken) < 1000


def test_a_foreign_exception_in_a_case_is_that_case_alone():
    results = outcomes(contain_errors(lambda number: 1 / number), [1, 0, 2], 2)
    assert (results[0], results[2]) == (1, 0.5)
    assert isinstance(results[1], qc.QuadcoreError)
    assert str(results[1]).startswith("ZeroDivisionError: division by zero (")


FEW_FILES = """
import os, resource
from quadcore.studies import executor

found = {}
most = 16 + max(int(name) for name in os.listdir("/proc/self/fd"))
resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
executor.run_cases(lambda number: -number, range(20), found.__setitem__, 16)
print(found == {i: -i for i in range(20)})
"""


@pytest.mark.parametrize("apart", [False, True])
def test_no_process_starts_without_a_case(apart, monkeypatch):
    forked = []

    def fork(fork=os.fork):
        forked.append(fork())
        return forked[-1]

    monkeypatch.setattr(os, "fork", fork)
    found = {}
    run_cases(abs, iter([-1, -2]), found.__setitem__, processes=8, apart=apart)
    assert found == {0: 1, 1: 2}
    assert len(forked) == 2


def test_fewer_processes_than_asked_for_do_all_cases():
    """A limit of open files that a few processes reach."""
    done = script(FEW_FILES)
    assert done.stdout == "True\n", done.stderr
