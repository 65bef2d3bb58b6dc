"""The command line: what it prints, what it writes, how it ends."""

from __future__ import annotations

import shlex
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import quadcore as qc
from quadcore.cli import info, main, terminal
from quadcore.formats import mat
from quadcore.model import resources

FALL = ["run", "quadrotor", "--duration", "0.05"]
RUN = ["log.csv", "model.urdf", "run.json"]


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    """Run every test in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def list_files():
    return sorted(path.name for path in Path().rglob("*") if path.is_file())


def refusal(capsys, *arguments):
    """Standard error of a command line that must be refused, one line."""
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    return err


def test_info_shows_the_whole_model(capsys):
    assert main(["info", "quadrotor"]) == 0
    out = capsys.readouterr().out
    for text in ("frame", "propeller4", "1.04", "0.0152542", "rotor4", "libmotorpid_plugin.so"):
        assert text in out


def test_info_puts_every_parameter_on_one_line_with_all_that_is_known_of_it(capsys):
    main(["info", "quadrotor", "--set", "drone_plugin.inducedDragCoeff=0.02"])
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines() if line.strip()}
    thrust = lines["drone_plugin.rotorThrustCoeff"]
    for text in (
        "0.000011487",
        "N s^2",
        "required",
        ">= 0",
        "urdf/quadrotor.urdf.xacro:",
        "thrust",
    ):
        assert text in thrust
    assert " --set " in lines["drone_plugin.inducedDragCoeff"]
    assert " default " in lines["motorpid_plugin.commandTimeout"]


def test_info_tells_all_of_a_parameter_in_80_columns():
    for plugin in qc.Simulation("quadrotor").plugins:
        lines = info._explain(plugin, 80).splitlines()
        assert max(map(len, lines)) <= 80
        words = " ".join(" ".join(lines).split())
        for parameter in plugin.parameters:
            for output in (parameter.name, parameter.meaning, parameter.range, parameter.unit):
                assert output in words, parameter.name


def test_run_prints_a_summary_and_writes_nothing_unasked(capsys):
    assert main(FALL) == 0
    out = capsys.readouterr().out
    rows = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert (rows["model"].strip(), rows["engine"].strip()) == ("quadrotor", "gazebo11")
    assert "9.98" in out  # 5 cm s of free fall from 10 m
    assert list_files() == []


def test_the_summary_tells_the_end_of_the_flight_however_little_is_logged(capsys):
    assert main([*FALL, "--log-every", "49"]) == 0
    seldom = capsys.readouterr().out
    assert main(FALL) == 0
    always = capsys.readouterr().out
    # The table is as wide as its steps per second have digits.
    seldom, always = ([line.rstrip() for line in out.splitlines()] for out in (seldom, always))
    final = [line for line in always if line.startswith("final")]
    assert len(final) == 2 and all(line in seldom for line in final)


def test_quiet_prints_nothing(capsys):
    assert main([*FALL, "--controller", "geometric", "--quiet", "--log", "log.csv"]) == 0
    assert capsys.readouterr() == ("", "")


def test_out_holds_the_log_and_the_plots(capsys):
    assert main([*FALL, "--out", "a/b", "--log", "log.mat"]) == 0
    plots = ["attitude", "path", "position", "rates", "rotors"]
    assert list_files() == sorted(
        [*RUN, "log.mat", "report.html", *(f"{name}.png" for name in plots)]
    )
    out = capsys.readouterr().out
    assert all(name in out for name in list_files())
    rows = np.loadtxt("a/b/log.csv", delimiter=",", skiprows=1)
    assert rows[:, 0] == pytest.approx(np.arange(51) * 1e-3)
    assert np.array_equal(scipy.io.loadmat("log.mat")["z"].ravel(), rows[:, 3])


def test_wrenches_are_in_logs_and_pictures_when_asked_for():
    assert main([*FALL, "--wrenches", "--out", ".", "--log", "log.mat"]) == 0
    assert "wrenches.png" in list_files()
    header = Path("log.csv").read_text().splitlines()[0]
    assert ",wrench_thrust.fx,wrench_thrust.fy,wrench_thrust.fz,wrench_thrust.tx," in header
    logs = [qc.Log.of_file(f"log{suffix}") for suffix in (".csv", ".mat")]
    expected = qc.Simulation("quadrotor").run(0.05, wrenches=True).wrenches
    for log in logs:
        assert log.wrenches.keys() == expected.keys()
        for name, rows in expected.items():
            assert np.array_equal(log.wrenches[name], rows)


def test_options_reach_the_flight():
    Path("c.csv").write_text("t,w1,w2,w3,w4\n0,500,-500,500,-500\n")
    options = "--engine ode --dt 0.002 --log-every 5 --spawn -1,0,3 --commands c.csv --no-plots"
    sim_slow = ["--xacro", "sim_slow:=1"]
    assert main([*FALL, *options.split(), *sim_slow, "--out", "."]) == 0
    assert list_files() == sorted(["c.csv", *RUN, "report.html"])
    rows = np.loadtxt("log.csv", delimiter=",", skiprows=1)
    assert rows[:, 0] == pytest.approx(np.arange(0, 0.051, 0.01))
    assert rows[0, 1:4] == pytest.approx([-1, 0, 3])
    assert rows[-1, 14] > 200


def test_the_same_seed_gives_the_same_bytes():
    noise = ["--set", "odometry.positionNoise=0.1", "--seed", "7", "--quiet"]
    assert main([*FALL, *noise, "--log", "a.csv"]) == 0
    assert main([*FALL, *noise, "--log", "b.csv"]) == 0
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ("fly quadrotor", "invalid choice: 'fly'"),
        ("runn quadrotor", "Did you mean 'run'?"),
        ("--verison", "unrecognized arguments: --verison. Did you mean '--version'?"),
        ("--options", "unrecognized arguments: --options. See quadcore --help."),
        ("run", "required: MODEL"),
        ("run nope.urdf", "nope.urdf: neither a file"),
        ("run qudrotor", "Did you mean 'quadrotor'?"),
        ("run quadrotor --bogus", "unrecognized arguments: --bogus"),
        ("run quadrotor --dur 1", "unrecognized arguments: --dur 1"),
        ("run quadrotor --enigne ode", "--enigne ode. Did you mean '--engine'? See quadcore run"),
        ("run quadrotor --engine bullet", "invalid choice: 'bullet'"),
        ("run quadrotor --engine eigne", "Did you mean 'eigen'?"),
        ("run quadrotor --world emtpy", "Did you mean 'empty'?"),
        ("run quadrotor --world nope.world", "nope.world: neither a file"),
        ("run quadrotor --dt 0", "--dt: 0 is not greater than 0"),
        ("run quadrotor --duration nan", "--duration: 'nan' is not a finite number"),
        ("run quadrotor --seed 1.5", "--seed: '1.5' is not a whole number"),
        ("run quadrotor --log-every 0", "--log-every: '0' is not a whole number from 1 on"),
        ("run quadrotor --spawn 1,2", "--spawn: '1,2' is not of the form"),
        ("run quadrotor --spawn -1,x,2", "--spawn: 'x' is not a finite number"),
        ("run quadrotor --set sim_slow=1", "--set: 'sim_slow=1' is not of the form"),
        ("run quadrotor --set a.b=1 --set a.b=2", "--set: a.b is given twice"),
        ("run quadrotor --set drone_plugin.nope=1", "nope"),
        ("run quadrotor --xacro sim_slow=1", "--xacro: 'sim_slow=1' is not of the form"),
        ("run quadrotor --commands nope.csv", "nope.csv: cannot be read"),
        ("run quadrotor --commands w.csv", "w.csv:3: w2 is nan"),
        ("run quadrotor --log nope/log.csv", "folder nope does not exist"),
        (
            "run quadrotor --log log.txt",
            "log.txt: logs are written to .csv, .mat, .bag, .ros2 files",
        ),
        ("run quadrotor --out w.csv", "w.csv: cannot be made: File exists"),
    ],
)
def test_bad_input_is_one_line_and_status_2(capsys, arguments, reason):
    Path("w.csv").write_text("t,w1,w2,w3,w4\n0,1,1,1,1\n1,1,nan,1,1\n")
    assert reason in refusal(capsys, *arguments.split())
    assert list_files() == ["w.csv"]


def test_an_unwritable_log_is_refused_before_the_flight(capsys, monkeypatch):
    monkeypatch.setattr("quadcore.Simulation.run", lambda *_: pytest.fail("has flown"))
    refusal(capsys, *FALL, "--log", "nope/log.csv")


def test_a_failed_flight_keeps_its_log_and_is_status_3(capsys):
    Path("c.csv").write_text("t,w1,w2,w3,w4\n0,500,-500,500,-500\n0.02,1e300,1e300,1e300,1e300\n")
    unlimited = ["--set", "xacro.max_velocity=1e301"]
    assert main([*FALL, *unlimited, "--commands", "c.csv", "--out", "out"]) == 3
    kept, error = capsys.readouterr().err.splitlines()
    assert kept.startswith("log until t = 0.0")
    assert error.startswith("error: ")
    assert "t = 0.0" in error
    assert np.isfinite(np.loadtxt("out/log.csv", delimiter=",", skiprows=1)).all()


def test_the_summary_counts_the_steps_that_reached_the_speed_limit(capsys):
    Path("c.csv").write_text("t,w1,w2,w3,w4\n0,500,-500,500,-500\n0.02,700,-500,700,-500\n")
    limit = ["--set", "motorpid_plugin.maxVelocity=600"]
    assert main(["run", "quadrotor", "--duration", "0.05", "--commands", "c.csv", *limit]) == 0
    assert "saturated steps         30" in capsys.readouterr().out


def test_an_interrupted_run_keeps_its_log_and_is_status_130(capsys, monkeypatch):
    @contextmanager
    def interrupting(quiet):
        yield lambda done, total: signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(terminal, "show_progress", interrupting)
    assert main(["run", "quadrotor", "--duration", "3600", "--log", "log.csv"]) == 130
    err = capsys.readouterr().err
    assert "log until t = " in err
    assert err.endswith("interrupted\n")
    assert len(np.loadtxt("log.csv", delimiter=",", skiprows=1)) > 1


def test_an_interrupt_while_the_log_is_written_waits_for_it(monkeypatch):
    write = mat.write_variables

    def write_and_interrupt(*what):
        signal.raise_signal(signal.SIGINT)
        write(*what)

    monkeypatch.setattr(mat, "write_variables", write_and_interrupt)
    assert main([*FALL, "--log", "log.mat"]) == 130
    assert len(scipy.io.loadmat("log.mat")["t"]) == 51


def test_a_second_interrupt_does_not_wait(monkeypatch):
    def interrupted_twice(*_):
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(scipy.io, "savemat", lambda *_, **__: interrupted_twice())
    assert main([*FALL, "--log", "log.mat"]) == 130
    assert list_files() == []


def test_warnings_go_to_standard_error(capsys):
    assert main([*FALL, "--set", "motorpid_plugin.ki=1"]) == 0
    assert capsys.readouterr().err.startswith("warning: ")


def test_the_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as left:
        main(["--version"])
    assert left.value.code == 0
    assert capsys.readouterr().out == f"quadcore {qc.__version__}\n"


def test_help_and_the_module_work_from_a_shell():
    shown = subprocess.run(
        [sys.executable, "-m", "quadcore", "run", "--help"], capture_output=True, text=True
    )
    assert shown.returncode == 0
    assert "--log-every" in shown.stdout


def test_help_names_what_is_shipped_and_where_a_flight_begins(capsys):
    with pytest.raises(SystemExit):
        main(["run", "--help"])
    output = " ".join(capsys.readouterr().out.split())
    models, worlds = (", ".join(resources.list_shipped(folder)) for folder in ("urdf", "worlds"))
    assert "quadrotor" in models and f"or a built-in model: {models} " in output
    assert "default" in worlds and f"or a built-in world: {worlds} (default: empty) " in output
    x, y, z = qc.FlightPlan.of().spawn[:3]
    assert f"in m and rad (default: {x:g},{y:g},{z:g})" in output


def test_a_reader_that_stops_early_is_no_error():
    python = shlex.quote(sys.executable)
    command = f"set -o pipefail; {python} -m quadcore info quadrotor | head -n 1"
    shown = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert shown.stdout == "model quadrotor\n"
    assert (shown.returncode, shown.stderr) == (0, "")


def test_the_command_alone_shows_what_there_is(capsys):
    assert main([]) == 2
    assert "evaluate" in capsys.readouterr().out


def test_a_mat_log_may_skip_steps():
    assert main([*FALL, "--log", "log.mat", "--log-every", "20", "--quiet"]) == 0
    assert np.array_equal(scipy.io.loadmat("log.mat")["t"].ravel(), [0, 0.02, 0.04])
