"""Odd surroundings: what is owed is one clear line and the right exit status, and nothing lost."""

from __future__ import annotations

import copy
import multiprocessing
import os
import pickle
import subprocess
from pathlib import Path

import numpy as np
import pytest
from flights import quadrotor
from processes import FALL, LONG, QUADCORE, run_command, run_refused, script

import quadcore as qc
from quadcore import _core
from quadcore.simulation.recording import DecimatedRows

pytestmark = pytest.mark.usefixtures("in_empty_folder")

TRIALS = int(os.environ.get("QUADCORE_TRIALS", "2"))  # ends of the interpreter beside a thread


# Threads and processes


def test_the_live_state_can_be_copied_pickled_and_sent():
    simulation = quadrotor()
    simulation.step(10)
    live = simulation.state
    for one in (copy.copy(live), copy.deepcopy(live), pickle.loads(pickle.dumps(live))):
        assert isinstance(one, qc.State)
        assert repr(one) == repr(live.copy())
    simulation.set_state(one)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(state_of_a_worker).get(LONG).time == pytest.approx(0.005)


def state_of_a_worker():
    simulation = quadrotor()
    simulation.step(5)
    return simulation.state


def test_a_fork_beside_a_thread_that_makes_its_first_simulation_can_make_one_too():
    made = script(
        """
import multiprocessing, threading, quadcore
context = multiprocessing.get_context("fork")
thread = threading.Thread(target=quadcore.Simulation)
thread.start()
children = []
while thread.is_alive() or not children:
    children.append(context.Process(target=quadcore.Simulation))
    children[-1].start()
thread.join()
for child in children:
    child.join(60)
print({child.exitcode for child in children})
"""
    )
    assert made.stdout == "{0}\n", made.stderr


def test_a_daemon_thread_that_steps_lets_the_interpreter_end():
    text = """
import threading, quadcore
simulation = quadcore.Simulation("quadrotor", engine="eigen")
def fly():
    while True: simulation.{}
threading.Thread(target=fly, daemon=True).start()
while simulation.time < 0.01: pass
"""
    for call in ("step(1000)", "run(0.1)", "step(3)"):
        for _ in range(TRIALS):
            ended = script(text.format(call))
            assert (ended.returncode, ended.stderr) == (0, "")


def test_a_simulation_that_is_not_made_yet_says_so():
    class Early(qc.Simulation):
        def __init__(self):
            self.step(self.command_width)
            super().__init__()

    with pytest.raises(qc.InputError, match=r"call super\(\).__init__\(\) first"):
        Early()
    with pytest.raises(qc.InputError, match="the object is empty"):
        _core.Flight(qc.Simulation.__new__(qc.Simulation), None, 1)


# Memory


LIMITED = """
import os, resource, quadcore
endless = {{"drone_plugin.dragModel": "chapter2"}}  # in a fall, other drags drive the vehicle
simulation = quadcore.Simulation("quadrotor", engine="eigen", parameters=endless)
simulation.run(0.1)
pages = int(open("/proc/self/statm").read().split()[0])
resource.setrlimit(resource.RLIMIT_AS, (pages * 4096 + {} * 2**20, -1))
try:
    simulation.run(1e6, wrenches=True)
except MemoryError as error:
    log = error.log
    resource.setrlimit(resource.RLIMIT_AS, (-1, -1))
    assert {{len(wrench) for wrench in log.wrenches.values()}} == {{len(log)}}
    print(len(log) * (log.table[0].nbytes + 48 * len(log.wrenches)) / 2**20)
"""


@pytest.mark.parametrize("megabytes", [60, 240])
def test_a_log_without_room_for_more_keeps_what_it_has(megabytes):
    kept = script(LIMITED.format(megabytes))
    assert float(kept.stdout) > 0.5 * megabytes - 10, kept.stderr


def measure_growth(*arguments):
    """MB that a command takes more than one that flies a tenth of its time."""

    def peak(duration):
        child = subprocess.Popen(
            [*QUADCORE, *FALL[:-1], str(duration), "--quiet", *arguments],
        )
        _, status, usage = os.wait4(child.pid, 0)
        assert status == 0
        return usage.ru_maxrss / 1024

    return peak(100) - peak(10)


@pytest.mark.parametrize("arguments", [[], ["--wrenches", "--log", "log.csv"]])
def test_a_long_run_takes_no_more_memory_than_a_short_one(arguments):
    assert measure_growth(*arguments) < 10  # 100 s with wrenches are 48 MB


def test_wrenches_are_logged_when_they_are_asked_for():
    simulation = quadrotor()
    log = simulation.run(0.1)
    assert log.wrenches == {}
    with pytest.raises(qc.InputError, match="Run the flight with wrenches=True"):
        log.wrenches["thrust"]
    asked = quadrotor().run(0.1, wrenches=True)
    assert np.array_equal(log.table, asked.table)
    assert list(asked.wrenches) == simulation.wrench_terms
    with pytest.raises(qc.InputError, match="'lift' does not exist"):
        asked.wrenches["lift"]


@pytest.mark.parametrize("rows", [1, 2, 20_000, 20_001, 45_000])
@pytest.mark.parametrize("piece", [1000, 7777, 10**6])
def test_pictures_are_drawn_from_rows_evenly_taken_and_the_last(rows, piece):
    simulation = quadrotor()
    table = np.arange(rows)[:, None] * np.ones((1, 18))
    wrenches = np.arange(rows)[:, None, None] * np.ones((1, len(simulation.wrench_terms), 6))
    thinned = DecimatedRows(rows, _core.flight_columns(simulation, []), simulation.wrench_terms)
    for begin in range(0, rows, piece):
        thinned.receive(table[begin : begin + piece], wrenches[begin : begin + piece])
    log = thinned.log()
    every = thinned.every
    expected = sorted({*range(0, rows, every), rows - 1})
    assert log.time.tolist() == expected and len(expected) <= 20_001
    assert log.wrenches["thrust"][:, 0].tolist() == expected
    assert log.title == {1: "", 2: "every 2nd row", 3: "every 3rd row"}[every]


# Streams and environment


def test_output_that_nobody_can_write_is_one_line_and_the_log_is_kept():
    with open("/dev/full", "w") as full:
        error = run_refused(*FALL, "--log", "log.csv", stdout=full)
    assert error == "error: standard output: No space left on device\n"
    assert len(np.loadtxt("log.csv", delimiter=",", skiprows=1)) == 51
    for arguments in (["info", "quadrotor"], ["--help"], ["--version"]):
        with open("/dev/full", "w") as full:
            run_refused(*arguments, stdout=full)


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_closed_streams_are_no_fault(closed):
    command = " ".join([*QUADCORE, *FALL, "--log", "log.csv", closed])
    assert subprocess.run(command, shell=True, timeout=LONG, check=False).returncode == 0
    assert len(np.loadtxt("log.csv", delimiter=",", skiprows=1)) == 51


@pytest.mark.parametrize(
    "environment",
    [
        {"PYTHONIOENCODING": "latin-1", "MPLBACKEND": "nonsense"},
        {"PYTHONIOENCODING": "ascii", "COLUMNS": "1"},
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "TERM": "dumb"},
    ],
)
def test_any_terminal_and_locale_will_do(environment, toy):
    Path("täst€.urdf").write_text(Path("toy.urdf").read_text())
    environment = {**os.environ, **environment}
    for arguments in (
        ["info", "täst€.urdf"],
        ["run", "täst€.urdf", "--duration", "0.02", "--out", "out"],
        ["compare", "täst€.urdf", "toy.urdf", "--duration", "0.02", "--out", "both", "--no-plots"],
    ):
        assert run_command(*arguments, env=environment).returncode == 0
    assert Path("out/path.png").exists()


def test_a_decimal_comma_of_the_locale_stays_out_of_messages_and_logs():
    text = """
import locale, quadcore
for name in ("de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"):
    try:
        locale.setlocale(locale.LC_ALL, name)
        break
    except locale.Error:
        continue
else:
    print("no such locale")
    raise SystemExit
unlimited = {"xacro.max_velocity": 1e301}
simulation = quadcore.Simulation("quadrotor", engine="eigen", parameters=unlimited)
simulation.run(0.01).to_csv("log.csv")
try:
    simulation.run(1, [[0, 1e300, 1e300, 1e300, 1e300]])
except quadcore.FlightError as error:
    print(error)
"""
    output = script(text).stdout
    if "no such locale" in output:
        pytest.skip("this system has no locale with a decimal comma")
    assert "t = 0.0" in output
    assert Path("log.csv").read_text().splitlines()[1].count(",") == 17
