"""Odd surroundings: what is owed is one clear line and the right exit status, and nothing lost."""

from __future__ import annotations

import copy
import multiprocessing
import os
import pickle
import resource
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from flights import quadrotor

import quadcore as qc
from quadcore import _core
from quadcore.cli import main
from quadcore.commands import read_commands
from quadcore.files import atomic_write
from quadcore.recording import Thinned

QUADCORE = [sys.executable, "-m", "quadcore"]
FALL = ["run", "quadrotor", "--engine", "eigen", "--duration", "0.05"]
LONG = 120.0  # s; generous, because waiting costs nothing when things work


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def ran(*arguments, **options):
    """A command, ended; its error output must be no traceback."""
    done = subprocess.run(
        [*QUADCORE, *arguments],
        stderr=subprocess.PIPE,
        stdout=options.pop("stdout", subprocess.PIPE),
        text=True,
        errors="replace",
        timeout=LONG,
        check=False,
        **options,
    )
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr
    return done


def script(text, **options):
    return subprocess.run(
        [sys.executable, "-c", text],
        capture_output=True,
        text=True,
        timeout=LONG,
        check=False,
        **options,
    )


def refused(*arguments, **options):
    done = ran(*arguments, **options)
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith("error: ") and done.stderr.count("\n") == 1
    return done.stderr


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
        for _ in range(4):
            ended = script(text.format(call))
            assert (ended.returncode, ended.stderr) == (0, "")


def test_a_simulation_that_is_not_made_yet_says_so():
    class Early(qc.Simulation):
        def __init__(self):
            self.step(self.command_width)
            super().__init__()

    with pytest.raises(qc.InputError, match=r"call super\(\).__init__\(\) first"):
        Early()
    with pytest.raises(qc.InputError, match="not made yet"):
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
    simulation.run(1e6)
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


def grown(*arguments):
    """MB that a command takes more than one that flies a tenth of its time."""

    def peak(duration):
        child = subprocess.Popen(
            [*QUADCORE, *FALL[:-1], str(duration), "--quiet", *arguments],
        )
        _, status, usage = os.wait4(child.pid, 0)
        assert status == 0
        return usage.ru_maxrss / 1024

    return peak(100) - peak(10)


@pytest.mark.parametrize("arguments", [[], ["--log", "log.csv"]])
def test_a_long_run_takes_no_more_memory_than_a_short_one(arguments):
    assert grown(*arguments) < 10  # 100 s with wrenches are 48 MB


def test_a_run_can_leave_out_the_wrenches():
    log = quadrotor().run(0.1, wrenches=False)
    assert log.wrenches == {}
    assert np.array_equal(log.table, quadrotor().run(0.1).table)


@pytest.mark.parametrize("rows", [1, 2, 20_000, 20_001, 45_000])
@pytest.mark.parametrize("piece", [1000, 7777, 10**6])
def test_pictures_are_drawn_from_rows_evenly_taken_and_the_last(rows, piece):
    simulation = quadrotor()
    table = np.arange(rows)[:, None] * np.ones((1, 18))
    wrenches = np.arange(rows)[:, None, None] * np.ones((1, len(simulation.wrench_terms), 6))
    thinned = Thinned(rows, simulation)
    for begin in range(0, rows, piece):
        thinned.receive(table[begin : begin + piece], wrenches[begin : begin + piece])
    log = thinned.log()
    every = thinned.every
    expected = sorted({*range(0, rows, every), rows - 1})
    assert log.time.tolist() == expected and len(expected) <= 20_001
    assert log.wrenches["thrust"][:, 0].tolist() == expected
    assert ("each" in log.title) == (every > 1)


# Files and folders


def test_a_log_through_a_link_keeps_link_and_mode():
    Path("there.csv").write_text("old")
    Path("there.csv").chmod(0o640)
    for name in ("here.csv", "here.mat"):
        Path(name).symlink_to("there.csv" if name == "here.csv" else "there.mat")
    Path("there.mat").write_text("old")
    Path("there.mat").chmod(0o640)
    assert main([*FALL, "--quiet", "--log", "here.csv", "--log", "here.mat"]) == 0
    for kind in ("csv", "mat"):
        assert Path(f"here.{kind}").is_symlink()
        assert Path(f"there.{kind}").stat().st_mode & 0o777 == 0o640
        assert Path(f"there.{kind}").stat().st_size > 1000


def test_a_device_is_written_and_stays_one():
    Path("null").symlink_to("/dev/null")
    with atomic_write(Path("null")) as stream:
        stream.write(b"nowhere")
    assert Path("null").is_char_device()


def test_a_log_that_cannot_be_written_does_not_take_the_other_with_it(capsys):
    Path("full.csv").symlink_to("/dev/full")
    assert main([*FALL, "--log", "full.csv", "--log", "good.csv", "--log", "good.mat"]) == 2
    error = capsys.readouterr().err
    assert error == "error: full.csv: cannot be written: No space left on device\n"
    assert len(np.loadtxt("good.csv", delimiter=",", skiprows=1)) == 51
    assert len(scipy.io.loadmat("good.mat")["t"]) == 51


def test_a_disk_that_fills_up_keeps_whole_rows(tmp_path):
    """A file size limit, which raises SIGXFSZ and EFBIG."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))

    refused(*FALL, "--log", "log.csv", preexec_fn=limit)
    text = Path("log.csv").read_text()
    assert text.endswith("\n") and 3000 < len(text) <= 4000
    rows = np.loadtxt("log.csv", delimiter=",", skiprows=1)
    assert rows[:, 0] == pytest.approx(1e-3 * np.arange(len(rows)))


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become nobody")
def test_a_folder_that_may_not_be_entered_is_one_line(tmp_path_factory):
    locked = tmp_path_factory.mktemp("locked")
    (locked / "in").mkdir()
    (locked / "in" / "a.urdf").touch()
    locked.chmod(0o700)
    path = str(locked / "in" / "a.urdf")
    program = f"""
import os, sys
from pathlib import Path
from quadcore.cli import main
import quadcore, quadcore.plots
os.setuid(65534)
for arguments in (["info", {path!r}], ["run", "quadrotor", "--world", {path!r}],
                  ["run", "quadrotor", "--log", {path!r}[:-5] + ".csv"],
                  ["run", "quadrotor", "--out", {path!r}],
                  ["run", "quadrotor", "--commands", {path!r}[:-5] + ".csv"]):
    assert main(arguments) == 2
try:
    quadcore.load_plugin_path({path!r})
except quadcore.InputError as error:
    print(error, file=sys.stderr)
"""
    lines = script(program).stderr.splitlines()
    assert len(lines) == 6 and all("ermission denied" in line for line in lines), lines


def test_a_name_that_is_too_long_is_one_line():
    name = "x" * 5000
    for arguments in (
        ["info", name],
        ["info", name + ".xacro"],
        [*FALL, "--world", name],
        [*FALL, "--log", name + ".csv"],
        [*FALL, "--out", name],
        [*FALL, "--commands", name + ".csv"],
    ):
        assert "File name too long" in refused(*arguments)


def test_a_name_that_is_no_utf8_is_a_name(toy):
    model = os.fsdecode(b"m\xff.urdf")
    Path(model).write_text(Path("toy.urdf").read_text())
    done = ran("run", model, "--duration", "0.01", "--log", os.fsdecode(b"l\xff.csv"))
    assert done.returncode == 0 and "l\\udcff.csv" in done.stdout
    assert Path(os.fsdecode(b"l\xff.csv")).exists()
    vary = ["--vary", "motor.kp=1e-4,2e-4", "--out", "out", "--duration", "0.01"]
    assert ran("compare", model, "toy.urdf", *vary).returncode == 0
    Path(model).write_text("<robot>")
    assert "m\\xff.urdf:1: " in refused("info", model)
    folder = os.fsdecode(b"p\xff")
    Path(folder).mkdir()
    qc.load_plugin_path(folder)
    assert os.path.realpath(folder) in qc.plugin_folders()


def test_a_name_cannot_steer_a_terminal(toy):
    Path("\x1b[31mred.urdf").write_text("<robot>")
    assert "\x1b" not in refused("info", "\x1b[31mred.urdf")
    done = ran("run", "toy.urdf", "--duration", "0.01", "--log", "\x1b[31m.csv")
    assert "\x1b" not in done.stdout and "\\x1b[31m.csv" in done.stdout


# Streams and environment


def test_output_that_nobody_can_write_is_one_line_and_the_log_is_kept():
    with open("/dev/full", "w") as full:
        error = refused(*FALL, "--log", "log.csv", stdout=full)
    assert error == "error: standard output: No space left on device\n"
    assert len(np.loadtxt("log.csv", delimiter=",", skiprows=1)) == 51
    for arguments in (["info", "quadrotor"], ["--help"], ["--version"]):
        with open("/dev/full", "w") as full:
            refused(*arguments, stdout=full)


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_closed_streams_are_no_fault(closed):
    command = " ".join([*QUADCORE, *FALL, "--log", "log.csv", closed])
    assert subprocess.run(command, shell=True, timeout=LONG, check=False).returncode == 0
    assert len(np.loadtxt("log.csv", delimiter=",", skiprows=1)) == 51


@pytest.mark.parametrize(
    "environment",
    [
        {"PYTHONIOENCODING": "latin-1"},
        {"PYTHONIOENCODING": "ascii"},
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        {"MPLBACKEND": "nonsense"},
        {"COLUMNS": "1"},
        {"TERM": "dumb"},
    ],
)
def test_any_terminal_and_locale_will_do(environment, toy):
    Path("täst€.urdf").write_text(Path("toy.urdf").read_text())
    environment = {**os.environ, **environment}
    for arguments in (
        ["info", "täst€.urdf"],
        ["run", "täst€.urdf", "--duration", "0.02", "--out", "out"],
        ["compare", "täst€.urdf", "toy.urdf", "--duration", "0.02", "--out", "out"],
    ):
        assert ran(*arguments, env=environment).returncode == 0
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
simulation = quadcore.Simulation("quadrotor", engine="eigen")
simulation.run(0.01).to_csv("log.csv")
try:
    simulation.run(1, [[0, 1e300, 1e300, 1e300, 1e300]])
except quadcore.FlightError as error:
    print(error)
"""
    told = script(text).stdout
    if "no such locale" in told:
        pytest.skip("this system has no locale with a decimal comma")
    assert "t = 0.0" in told
    assert Path("log.csv").read_text().splitlines()[1].count(",") == 17


# Arguments


def test_commands_that_are_no_real_numbers_are_refused():
    simulation = quadrotor()
    masked = np.ma.array([1.0, 2, 3, 4], mask=[0, 1, 0, 0])
    for speeds in (["1", "2", "3", "4"], masked, [1j, 0, 0, 0], np.array([None, 1, 2, 3])):
        with pytest.raises(qc.InputError, match="array of numbers"):
            simulation.command(speeds)
        with pytest.raises(qc.InputError, match="not a table of real numbers"):
            row = np.ma.concatenate([[0], speeds]) if speeds is masked else [0, *speeds]
            simulation.run(0.1, row[None] if speeds is masked else [row])
    simulation.command([1, 2, 3, np.float32(4)])


def test_an_interrupt_inside_an_argument_is_one():
    class Interrupting:
        def __array__(self, *_, **__):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        quadrotor().command(Interrupting())


@pytest.mark.parametrize("number", ["1_0e-3", "\u0661", "1e", "0x1p3", "nan", "1,5"])
def test_numbers_are_those_of_a_urdf_everywhere(number, capsys):
    Path("c.csv").write_text(f"t,w1,w2,w3,w4\n0,1,1,1,{number}\n", encoding="utf-8")
    for option in ("--dt", "--duration", "--spawn", "--seed"):
        value = f"0,0,{number}" if option == "--spawn" else number
        assert main(["run", "quadrotor", option, value]) == 2
    assert main(["compare", "quadrotor", "--vary", f"motorpid_plugin.kp=1e-4:{number}:3"]) == 2
    assert main(["run", "quadrotor", "--commands", "c.csv"]) == 2
    with pytest.raises(qc.InputError):
        qc.Simulation("quadrotor", spawn=(0, 0, number))
    assert capsys.readouterr().err.count("error: ") == 6


def test_a_pipe_as_commands_is_refused():
    for name in ("c.csv", "c.mat"):
        os.mkfifo(name)
        assert "is no regular file" in refused(*FALL, "--commands", name)


def test_a_mat_file_is_not_unpacked_beyond_what_can_be_meant():
    names = ["t", "w1", "w2", "w3", "w4"]
    scipy.io.savemat(
        "c.mat", {name: np.zeros(10**7 + 1) for name in names[:1]}, do_compression=True
    )
    with pytest.raises(qc.InputError, match="takes t, w1"):
        read_commands("c.mat", 4)
    scipy.io.savemat("d.mat", {"t": np.zeros(10**7 + 1), "w1": [0.0]}, do_compression=True)
    with pytest.raises(qc.InputError, match="t has 10000001 values; at most 10000000 are read"):
        read_commands("d.mat", 1)


def test_a_csv_file_has_a_largest_size(monkeypatch):
    Path("c.csv").write_text("t,w1\n0,1\n")
    monkeypatch.setattr("quadcore.commands._LARGEST", 8)
    with pytest.raises(qc.InputError, match="is larger than"):
        read_commands("c.csv", 1)


def test_engine_and_world_are_varied_alone():
    assert "vary each" in refused("compare", "quadrotor", "--vary", "engine,world=eigen")


def test_a_time_at_which_the_clock_would_stand_still_is_refused():
    simulation = quadrotor()
    state = simulation.state.copy()
    state.time = 1e300
    with pytest.raises(qc.InputError, match="the time is beyond 1e9 s"):
        simulation.set_state(state)


def test_no_negative_zero_is_printed(capsys):
    commands = "t,w1,w2,w3,w4\n0,-1,1,-1.0001,1\n"
    Path("c.csv").write_text(commands)
    for _ in range(2):
        assert main([*FALL, "--spawn=-0.0,-1e-9,1", "--commands", "c.csv"]) == 0
    assert "-0.0000" not in capsys.readouterr().out


def test_each_log_is_written_once_and_holds_what_its_name_says(capsys):
    assert main([*FALL, "--quiet", "--log", "a.csv", "--log", "b.csv"]) == 0
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()
    assert main([*FALL, "--log", "c.csv", "--log", "./c.csv"]) == 2
    assert "would be written twice" in capsys.readouterr().err
    log = quadrotor().run(0.01)
    for write in (log.to_csv, log.to_mat):
        with pytest.raises(qc.InputError, match="name a file that ends in"):
            write("a.npz")


def test_a_flight_shorter_than_a_step_is_refused(capsys):
    assert main(["run", "quadrotor", "--duration", "1e-5"]) == 2
    assert "nothing would fly" in capsys.readouterr().err
    assert len(quadrotor().run(0)) == 1


def test_a_cell_that_a_spreadsheet_would_run_is_text(toy):
    Path("=1+1.urdf").write_text(Path("toy.urdf").read_text())
    assert (
        ran("compare", "=1+1.urdf", "toy.urdf", "--duration", "0.01", "--out", "out").returncode
        == 0
    )
    assert "1,'=1+1.urdf," in Path("out/table.csv").read_text()


def test_tables_are_written_before_pictures(toy, monkeypatch):
    def fail(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("quadcore.plots.png", fail)
    vary = ["--vary", "motor.kp=1e-4,2e-4", "--duration", "0.01", "--out", "out"]
    assert main(["compare", "toy.urdf", *vary]) == 130
    assert Path("out/table.csv").exists() and Path("out/comparison.json").exists()


def test_a_view_read_beside_a_step_is_not_a_copy():
    """`copy` is of one moment, or refused: positions and velocities belong together."""
    drags = ("induced", "translational", "profile", "parasitic")
    still = {f"drone_plugin.{drag}DragCoeff": 0 for drag in drags}
    simulation = quadrotor("eigen", parameters=still)
    ending = threading.Event()

    def fly():
        while not ending.wait(0.001):
            simulation.step(200)

    thread = threading.Thread(target=fly)
    thread.start()
    copies = 0
    give_up = time.monotonic() + LONG
    while copies < 20 and time.monotonic() < give_up:
        try:
            state = simulation.state.copy()
        except qc.InputError:
            continue
        copies += 1
        assert state.linear_velocity[2] == pytest.approx(-9.8 * state.time, rel=1e-9)
        assert state.position[2] == pytest.approx(10 - 4.9 * state.time**2, rel=1e-9)
    ending.set()
    thread.join()
