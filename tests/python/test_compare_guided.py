"""Comparing flights in closed loop."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from compared import rows

import quadcore as qc
from quadcore.cli import main
from quadcore.control import controllers, references

FLY = ["--xacro", "sim_slow:=1", "--duration", "0.5", "--quiet"]
SPIRAL = ["--controller", "geometric:kp_xy=5", "--reference", "spiral:radius=1.5"]
ENGINES = ["--vary", "engine=eigen,ode"]

OWN = """
calls = 0
class Holds:
    def __call__(self, t, state, reference):
        return [471, -471, 471, -471]
class Counts:
    rate = 100
    def __call__(self, t, state, reference):
        global calls
        calls += 1
        return [471 + calls, -471, 471, -471]
class Raises:
    def __call__(self, t, state, reference):
        if t >= 0.1:
            raise ValueError("no idea")
        return [471, -471, 471, -471]
"""

pytestmark = pytest.mark.usefixtures("in_empty_folder")


@pytest.fixture(autouse=True)
def own(in_empty_folder, monkeypatch):
    Path("own.py").write_text(OWN)
    monkeypatch.delitem(__import__("sys").modules, "own", raising=False)


def compare(*arguments, status=0):
    assert main(["compare", "quadrotor", *FLY, *arguments]) == status


def log_of(number):
    return qc.Log.of_file(f"out/logs/{number}.csv")


@pytest.mark.parametrize(
    "more",
    [
        SPIRAL,
        [*SPIRAL, "--spawn", "1,2,9,0,0,0.5"],
        ["--controller", "pid", "--spawn", "1,2,9,0,0,0.5"],
        [*SPIRAL, "--controller-rate", "250", "--delay", "0.004", "--scenario", "gusty"],
        ["--controller", "own:Holds", "--reference", "hover", "--wrenches"],
    ],
    ids=["on the reference", "beside it", "hover at the spawn", "timing", "own"],
)
def test_each_flight_is_that_of_run(more):
    compare(*ENGINES, *more, "--out", "out", "--no-plots")
    for number, engine in enumerate(("eigen", "ode"), start=1):
        command = ["run", "quadrotor", *FLY, *more, "--engine", engine]
        assert main([*command, "--log", f"{engine}.csv"]) == 0
        flown = Path(f"out/logs/{number}.csv").read_bytes()
        assert flown == Path(f"{engine}.csv").read_bytes(), engine
    assert Path("eigen.csv").read_bytes() != Path("ode.csv").read_bytes()


def test_tracking_errors_are_in_table_page_and_terminal(capsys):
    arguments = [argument for argument in FLY if argument != "--quiet"]
    vary = ["--vary", "frame.mass=1.0,1.3"]
    guided = [*SPIRAL, "--engine", "eigen", *vary]
    assert main(["compare", "quadrotor", *arguments, *guided, "--out", "out"]) == 0
    shown, page = capsys.readouterr().out, Path("out/report.html").read_text()
    assert "tracking error (m), RMS / max" in shown
    assert ">Tracking error</h2>" in page
    for number, row in enumerate(rows(), start=1):
        log = log_of(number)
        wanted = 1.5 * np.cos(0.5 * log.time), 1.5 * np.sin(0.5 * log.time), 10 + log.time
        away = np.linalg.norm(log.position - np.transpose(wanted), axis=1)
        assert float(row["rms_error"]) == pytest.approx(np.sqrt(np.mean(away**2)), rel=1e-6)
        assert float(row["max_error"]) == pytest.approx(away.max(), rel=1e-6)
        for expected in (row["rms_error"], row["max_error"]):
            assert f"{float(expected):.4g}" in shown and f"{float(expected):.4g}" in page
    flight = json.loads(Path("out/comparison.json").read_text())["flight"]
    assert flight["controller"] == "geometric:kp_xy=5" and flight["spawn"] == "on the reference"
    assert "commands" not in flight


def test_distances_to_the_reference_are_those_of_an_evaluation():
    options = {"duration": 0.5, "log_every": 7, "xacro_args": {"sim_slow": 1}, "processes": 1}
    found = qc.compare(
        "quadrotor",
        {"engine": ["eigen", "ode"]},
        controller="geometric",
        reference="spiral",
        **options,
    )
    known = qc.evaluate("geometric", "spiral", engines=["eigen", "ode"], **options).table
    assert 0 < known[0]["rms_position"] < known[0]["max_position"]
    for name in ("rms", "max"):
        measured = [row[f"{name}_position"] for row in known]
        assert found.table[f"{name}_error"].tolist() == measured


def test_failures_are_reported_below_the_table(capsys):
    command = "compare quadrotor --controller own:Raises --reference hover --duration 0.2"
    assert main([*command.split(), "--vary", "odometry.positionNoise=0,0.1"]) == 3
    reason = "the flight failed at t = 0.100000 s: controller: ValueError: no idea"
    *table, first, second, _ = capsys.readouterr().out.partition("\nno.")[2].splitlines()
    assert first.startswith(f"no. 1 (positionNoise 0): {reason}")
    assert second.startswith(f"no. 2 (positionNoise 0.1): {reason}")
    assert [line.split() for line in table[1:3]] == [
        ["1", "positionNoise", "0", "failed"],
        ["2", "positionNoise", "0.1", "failed"],
    ]


def test_from_python_controllers_and_references_are_given_as_for_run():
    class Hover:
        rate = 100

        def __call__(self, t, state, reference):
            return [471 + reference.yaw, -471, 471, -471]

    options = {"duration": 0.2, "xacro_args": {"sim_slow": 1}}
    for controller in (controllers.geometric(kp_xy=5), Hover(), "pid"):
        found = qc.compare(
            "quadrotor",
            {"engine": ["eigen", "ode"]},
            controller=controller,
            reference=references.spiral(radius=1.5),
            delay=0.002,
            **options,
        )
        assert list(found.table["failure"]) == ["", ""]
        begun = references.spiral(radius=1.5)(0)
        for log in found.logs:
            assert np.allclose(log.position[0], begun.position)
            assert np.allclose(log.linear_velocity[0], begun.velocity)
        assert found.table["max_error"][0] > 0
    open_loop = qc.compare("quadrotor", {"engine": ["eigen", "ode"]}, **options)
    assert "rms_error" not in open_loop.table.dtype.names


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_what_a_module_remembers_of_a_flight_no_other_flight_knows(jobs):
    vary = ["--vary", "odometry.positionNoise=0,0.1,0.2"]  # which the controller does not heed
    guided = ["--controller", "own:Counts", "--reference", "hover", "--engine", "eigen"]
    compare(*vary, *guided, "--jobs", jobs, "--out", "out", "--no-plots")
    tables = [log_of(number).table for number in (1, 2, 3)]
    assert all(np.array_equal(tables[0], table) for table in tables)


def test_a_controller_that_raises_is_a_row_with_the_time():
    vary = ["--vary", "motorpid_plugin.kp=0.0005,0.001"]
    compare(*vary, "--controller", "own:Raises", "--out", "out", "--no-plots", status=3)
    for row in rows():
        expected = "the flight failed at t = 0.100000 s: controller: ValueError: no idea ("
        assert row["failure"].startswith(expected)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ("--commands c.csv --controller pd", "--commands and --controller exclude each other"),
        ("--reference spiral", "--reference requires a controller. Add --controller."),
        ("--delay 0.1", "--delay requires a controller. Add --controller."),
        ("--controller pdd", "controller 'pdd' does not exist"),
        ("--controller pd --reference spirl", "reference 'spirl' does not exist"),
        ("--controller geometric:kp=3", "controller 'geometric' has no parameter 'kp'"),
        ("--controller pd --controller-rate 0", "--controller-rate: 0 is not greater than 0"),
        ("--controller pd --reference 2", "To choose the baseline flight, use --against"),
        ("--reference 2", "To choose the baseline flight, use --against 2"),
    ],
)
def test_bad_guidance_is_one_line_and_nothing_is_flown(capsys, monkeypatch, arguments, expected):
    monkeypatch.setattr(qc.Simulation, "run", lambda *_, **__: pytest.fail("flown"))
    compare(*ENGINES, *arguments.split(), "--out", "out", status=2)
    error = capsys.readouterr().err
    assert error.startswith("error: ") and error.count("\n") == 1 and expected in error


def test_from_python_bad_guidance_is_refused():
    vary = {"engine": ["eigen", "ode"]}
    for given, expected in (
        ({"reference": 1}, "`against` is the baseline"),
        ({"reference": "hover"}, "reference requires a controller"),
        ({"controller": "pd", "commands": [[0, 1, 1, 1, 1]]}, "Give one of them"),
        ({"controller": 3}, "controller is 3"),
    ):
        with pytest.raises(qc.InputError, match=expected):
            qc.compare("quadrotor", vary, **given)
