"""One controller in Python, as a plugin, and as a client of `quadcore serve`: the same flight."""

from __future__ import annotations

import math
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
import yaml
from builds import build

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.evaluate.trial import Trial
from quadcore.studies.measured_flight import fly_and_measure
from quadcore.studies.options import EvaluateOptions
from quadcore.studies.sweep.row_spec import read_source

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "lee"
REFERENCE = "circle:radius=1,rate=1"
OPTIONS = {"xacro_args": {"sim_slow": 1}, "spawn": (1, 0, 10), "duration": 1}
ERRORS = ("rms_position", "max_position", "iae_position", "max_yaw")


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return build(EXAMPLE, tmp_path_factory.mktemp("lee")) / "liblee_plugin.so"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def check_equal(row, other):
    assert row["failure"] == other["failure"] == ""
    for name in ERRORS:
        assert row[name] == pytest.approx(other[name], abs=1e-9), name


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_python_and_plugin_are_equal_in_one_table(engine, library):
    of_python = f"{EXAMPLE / 'lee.py'}:Lee"
    mine = [of_python, f"{of_python}:kx=9,kw=14", str(library), f"{library}:kx=9,kw=14"]
    rows = qc.evaluate(mine, [REFERENCE, "step:time=0.5"], engine=engine, **OPTIONS).table
    for row, other in zip(rows[:4], rows[4:]):
        check_equal(row, other)
    assert rows[0]["rms_position"] != rows[2]["rms_position"]


def test_a_client_of_serve_is_equal_in_the_same_table(monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLE))
    monkeypatch.delitem(sys.modules, "lee", raising=False)
    from lee_client import main as drive

    command = [sys.executable, "-m", "quadcore", "serve", "quadrotor", "--engine", "eigen"]
    command += ["--xacro", "sim_slow:=1", "--spawn", "1,0,10", "--log", "served.csv"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        drive(server.stdout.readline().strip().rpartition(":")[2], REFERENCE, "0.5")
        server.send_signal(signal.SIGINT)
    mine = f"{EXAMPLE / 'lee.py'}:Lee"
    options = {**OPTIONS, "duration": 0.5, "log_every": 1}
    found = qc.measure({"served": "served.csv"}, REFERENCE, mine, **options)
    check_equal(*found.table)


def test_tags_of_a_plugin_can_be_varied(library):
    varied = {"controller.kx": [4, 9]}
    rows = qc.evaluate(str(library), REFERENCE, vary=varied, **OPTIONS).table
    single = qc.evaluate(f"{library}:kx=9", REFERENCE, **OPTIONS).table
    assert rows[1]["rms_position"] == single[0]["rms_position"]
    assert rows[0]["rms_position"] != single[0]["rms_position"]


def test_a_sweep_notices_a_rebuilt_plugin(library, monkeypatch):
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(library.parent))
    words = ["sweep", "--controller", library.name, "--reference", REFERENCE, "--out", "out"]
    words += ["--vary", "controller.kx=4,9", "--duration", "0.5", "--xacro", "sim_slow:=1"]
    assert main([*words, "--quiet", "--no-plots"]) == 0
    assert read_source(library.name) == library.read_bytes()


def test_a_search_of_gains_is_that_of_the_python_twin(library):
    found = {}
    for name, text in (("python", f"{EXAMPLE / 'lee.py'}:Lee"), ("plugin", f"{library}:kr=70")):
        words = ["tune", text, "--free", "kx,kv", "--budget", "2", "-o", f"{name}.yaml"]
        words += ["--reference", REFERENCE, "--hold-out", "hover", "--duration", "0.5"]
        words += [] if name == "plugin" else ["--vary", "controller.kr=70"]
        assert main([*words, "--xacro", "sim_slow:=1", "--quiet"]) == 0
        found[name] = yaml.safe_load(Path(f"{name}.yaml").read_text())
    python, plugin = found["python"], found["plugin"]
    assert plugin["history"]["evaluations"] == pytest.approx(
        python["history"]["evaluations"], abs=1e-9
    )
    assert plugin["law"] == str(library) and plugin["history"]["privileged"]
    assert "rate" not in plugin and plugin["parameters"]["kr"] == 70
    rows = qc.evaluate(["plugin.yaml", f"{library}:kr=70"], REFERENCE, **OPTIONS).table
    assert rows[0]["controller"] == "plugin.yaml (privileged)" and rows[0]["failure"] == ""
    assert rows[0]["rms_position"] != rows[1]["rms_position"]
    Path("rate.yaml").write_text(f"law: {library}\nrate: 100\n")
    refused = qc.evaluate("rate.yaml", REFERENCE, **OPTIONS).table[0]["failure"]
    assert "is a plugin, which sets its own rate and delay. Remove both." in refused


def test_the_delay_margin_of_a_plugin_is_searched_on_the_odometry(library, recwarn):
    plan = Plan(
        [f"{EXAMPLE / 'lee.py'}:Lee", str(library)], "hover", ["eigen"], ["quadrotor"], {},
        EvaluateOptions(duration=2, xacro_args={"sim_slow": 1}),
    )  # fmt: skip
    slow, slow_plugin, plugin = (
        fly_and_measure(partial(trial._replace(kicked=True).make_plan, plan), 60, watch=True).motion
        for trial in (Trial(0, delay=0.02), Trial(1, delay=0.02), Trial(1))
    )
    # The loop has the same delay, in the odometry or in the command.
    size = abs(slow - plugin).max()
    assert abs(slow - slow_plugin).max() < 0.1 * size > 1e-3
    found = qc.evaluate(
        str(library), "hover", duration=2, margins=True, xacro_args={"sim_slow": 1}
    )  # fmt: skip
    (row,) = found.margins
    assert row["failure"] == "" and 0.02 < row["delay_margin"] < 0.2
    assert all(math.isnan(row[name]) for name in ("gain_low", "rms_at_100_Hz", "box_worst"))
    assert "only the delay is searched" in str(recwarn.pop(qc.QuadcoreWarning).message)


def test_tables_mark_a_plugin_which_sees_the_whole_simulation(library):
    found = qc.evaluate(str(library), "hover", duration=0.1)
    assert found.table[0]["controller"] == f"{library} (privileged)"


def test_run_flies_a_plugin(library, capsys):
    words = ["run", "quadrotor", "--engine", "eigen", "--xacro", "sim_slow:=1", "--duration", "1"]
    assert main([*words, "--controller", f"{library}:kx=9", "--reference", REFERENCE]) == 0
    printed = capsys.readouterr().out
    assert f"controller              {library}:kx=9\n" in printed and "max error" in printed
    assert "saturated updates" not in printed


def test_wrong_plugins_are_refused(library, capsys):
    for controller, message in (
        ("missing/liblee_plugin.so", "missing/liblee_plugin.so: cannot be read"),
        (f"{library}:ky=9", "ky"),
        ("libwind_plugin.so", "libwind_plugin.so"),
    ):
        words = ["evaluate", "--controller", controller, "--reference", "hover"]
        assert main([*words, "--duration", "0.1", "--quiet"]) == 2, controller
        assert message in capsys.readouterr().err
