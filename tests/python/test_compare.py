"""Comparisons of models and parameters: differences, flights and refusals."""

from __future__ import annotations

import json
import math
import os
import signal
from pathlib import Path

import faults
import numpy as np
import pytest
from compared import FLIGHT, commands, line_of, rows  # noqa: F401
from processes import outcomes

import quadcore as qc
from quadcore.cli import main
from quadcore.model import resources
from quadcore.studies import flight_differences
from quadcore.studies.compare import Comparison
from quadcore.support.rotation import to_roll_pitch_yaw

pytestmark = pytest.mark.usefixtures("toy")

SPIN = {"engine": "eigen", "duration": 0.1, "commands": np.array([[0.0, 400.0]])}
SLOW = "air.sim_slow,motor.sim_slow"


def edit_toy(name, old, new):
    """Write a copy of the toy with one change; returns its name."""
    assert faults.MODEL.count(old) == 1
    Path(name).write_text(faults.MODEL.replace(old, new))
    return name


def list_differences(capsys, *models):
    """Differences that the command line tells, cells of each row, and its exit status."""
    status = main(["compare", *models, *FLIGHT])
    lines = capsys.readouterr().out.split("\n\n")[0].splitlines()[2:]
    return status, [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in lines]


# What differs between the models


def test_an_edited_tag_is_reported_alone_with_both_values_and_lines(capsys):
    edit_toy("b.urdf", "<kp>5e-4</kp>", "<!-- stiffer,\nby far -->\n<kp>1e-3</kp>")
    status, found = list_differences(capsys, "toy.urdf", "b.urdf")
    assert status == 0
    places = [f"{name}:{line_of(name, '<kp>')}" for name in ("toy.urdf", "b.urdf")]
    assert found == [["motor.kp", "5e-4", "1e-3", *places]]


@pytest.mark.parametrize(
    ("old", "new", "row"),
    [
        ('mass value="1"', 'mass value="1.5"', ["link frame/inertial/mass value", "1", "1.5"]),
        ('izz="0.04"', 'izz="0.039"', ["link frame/inertial/inertia izz", "0.04", "0.039"]),
        ('xyz="0 0 0.1"', 'xyz="0 0 0.2"', ["joint rotor/origin xyz", "0 0 0.1", "0 0 0.2"]),
        ('damping="1e-6"', "", ["joint rotor/dynamics damping", "1e-6", "absent"]),
        ("<sim_slow>10.0</sim_slow>", "<!-- -->", ["motor.sim_slow", "10.0", "absent"]),
        ("<rate>100</rate>", "<publishTf>1</publishTf>", ["odometry.rate", "100", "absent"]),
        ('length="0.02"', 'length="0.03"', ["cylinder length", "0.02", "0.03"]),
    ],
)
def test_any_other_change_is_reported_as_well(capsys, old, new, row):
    edit_toy("b.urdf", old, new)
    _, found = list_differences(capsys, "toy.urdf", "b.urdf")
    what, before, after, place, _ = found[0]
    assert what.endswith(row[0])
    assert [before, after] == row[1:]
    assert place == f"toy.urdf:{line_of('toy.urdf', old)}"


def test_a_removed_plugin_is_one_line(capsys):
    start = faults.MODEL.index('    <plugin name="odometry"')
    edit_toy("b.urdf", faults.MODEL[start : faults.MODEL.index("  </gazebo>", start)], "")
    status, found = list_differences(capsys, "toy.urdf", "b.urdf")
    assert status == 0
    assert found[0] == [
        "plugin odometry",
        "libodometry_plugin.so",
        "absent",
        f"toy.urdf:{line_of('toy.urdf', 'name=' + chr(34) + 'odometry')}",
        "-",
    ]
    assert len(found) == 1


def test_lines_of_a_xacro_are_those_of_its_file(capsys):
    source = (
        faults.MODEL.replace('<robot name="toy">', '<robot xmlns:xacro="x" name="toy">')
        .replace('xmlns:xacro="x"', 'xmlns:xacro="http://www.ros.org/wiki/xacro"')
        .replace('<mass value="1"/>', '<mass value="${1 + 1}"/>')
    )
    Path("b.xacro").write_text(source)
    _, found = list_differences(capsys, "toy.urdf", "b.xacro")
    place = f"b.xacro:{line_of('b.xacro', '${1 + 1}')}"
    assert found[0][-1] == place
    assert len(found) == 1


def test_numbers_written_otherwise_and_order_are_no_difference_but_that_of_joints_is():
    model = str(resources.find_root() / "urdf" / "quadrotor.urdf.xacro")
    text = Path(model).read_text()
    assert "0.000011487" in text
    Path("same.xacro").write_text(text.replace("0.000011487", "1.1487e-5"))
    one, two = '<xacro:propeller i="1" mat="red"/>', '<xacro:propeller i="2" mat="blue"/>'
    Path("order.xacro").write_text(text.replace(one, "@").replace(two, one).replace("@", two))
    found = qc.compare(
        [model, "same.xacro", "order.xacro"], engine="eigen", duration=0.01
    ).differences
    assert found["same.xacro"] == []
    assert [row.what for row in found["order.xacro"]] == ["order of the joints"]
    assert found["order.xacro"][0].after == "rotor2 rotor1 rotor3 rotor4"


# What is flown


@pytest.mark.parametrize("wrenches", [[], ["--wrenches"]], ids=["bare", "wrenches"])
@pytest.mark.parametrize("engine", [name for name, _ in qc.engines()])
def test_an_edit_and_vary_and_run_give_the_same_bytes(engine, wrenches):
    edit_toy("b.urdf", "<kp>5e-4</kp>", "<kp>0.00123</kp>")
    flight = ["--engine", engine, *FLIGHT[2:], "--quiet", "--no-plots", *wrenches]
    assert main(["compare", "toy.urdf", "b.urdf", *flight, "--out", "e"]) == 0
    vary = ["--vary", "motor.kp=5e-4,0.00123"]
    assert main(["compare", "toy.urdf", *vary, *flight, "--out", "v"]) == 0
    assert main(["run", "b.urdf", *flight, "--out", "r"]) == 0
    for number in (1, 2):
        assert (
            Path(f"e/logs/{number}.csv").read_bytes() == Path(f"v/logs/{number}.csv").read_bytes()
        )
    assert Path("v/logs/2.csv").read_bytes() == Path("r/log.csv").read_bytes()
    assert Path("v/logs/1.csv").read_bytes() != Path("v/logs/2.csv").read_bytes()
    assert bool(qc.Log.of_file("v/logs/2.csv").wrenches) == bool(wrenches)


def test_a_grid_of_tags_engines_and_worlds_in_the_order_given():
    Path("windless.world").write_text(faults.WORLD.replace("1 0 0", "0 0 0"))
    vary = {SLOW: [1, 2], "engine": ["ode", "eigen"], "world": ["toy.world", "windless.world"]}
    result = qc.compare("toy.urdf", vary, duration=0.02, parameters={"air.dragModel": "chapter2"})
    assert isinstance(result, Comparison)
    assert list(result.table["failure"]) == [""] * 8
    assert list(result.table[SLOW]) == [1] * 4 + [2] * 4
    assert list(result.table["engine"]) == ["ode", "ode", "eigen", "eigen"] * 2
    assert list(result.table["world"]) == ["toy.world", "windless.world"] * 4
    alone = qc.Simulation(
        "toy.urdf",
        "eigen",
        "windless.world",
        parameters={"air.sim_slow": 2, "motor.sim_slow": 2, "air.dragModel": "chapter2"},
    )
    assert np.array_equal(result.logs[7].table, alone.run(0.02).table)


def test_varied_parameters_are_not_listed_as_common():
    vary = ["--vary", "engine=ode,eigen", "--spawn", "0,0,3", "--no-plots"]
    assert main(["compare", "toy.urdf", *FLIGHT, *vary, "--out", "out"]) == 0
    shared = json.loads(Path("out/comparison.json").read_text())["flight"]
    assert "engine" not in shared and shared["spawn"] == "0, 0, 3"


def test_ranges():
    vary = ["--vary", "motor.kp=log:1e-4:1e-2:3", "--vary", "air.rotorTorqueCoeff=0:3e-7:4"]
    arguments = ["compare", "toy.urdf", *FLIGHT, "--quiet", "--no-plots"]
    assert main([*arguments, *vary, "--out", "out"]) == 0
    assert [row["motor.kp"] for row in rows()[::4]] == ["0.0001", "0.001", "0.01"]
    assert [row["air.rotorTorqueCoeff"] for row in rows()[:4]] == ["0.0", "1e-07", "2e-07", "3e-07"]


def test_the_number_of_processes_changes_no_byte():
    arguments = ["compare", "toy.urdf", *FLIGHT, "--quiet", "--vary", "motor.kp=1e-4:1e-2:7"]
    for jobs in "1", "3":
        assert main([*arguments, "--jobs", jobs, "--out", jobs]) == 0
    files = sorted(path.relative_to("1") for path in Path("1").rglob("*") if path.is_file())
    assert len(files) == 18  # 7 logs, 6 pictures, table, numbers, report, model, run.json
    for file in files:
        one, other = ((Path(jobs) / file).read_bytes() for jobs in ("1", "3"))
        if file.suffix == ".html":  # its head has the date and the command line
            one, other = (page.partition(b"</header>")[2] for page in (one, other))
        if file.name == "run.json":  # so has its first part
            one, other = (text.partition(b'"worlds"')[2] for text in (one, other))
        assert one == other != b"", file


def test_metrics_are_those_of_the_logs():
    result = qc.compare("toy.urdf", {"motor.kp": [1e-4, 2e-4]}, **SPIN)
    a, b = result.logs
    row = result.table[1]
    assert row["final_z"] == b.table[-1, 3] - a.table[-1, 3]
    apart = np.linalg.norm(b.position - a.position, axis=1)
    assert row["max_position"] == pytest.approx(apart.max(), rel=1e-12)
    yaw = (to_roll_pitch_yaw(b.orientation) - to_roll_pitch_yaw(a.orientation))[:, 2]
    assert row["max_yaw"] == pytest.approx(np.abs(yaw).max(), rel=1e-9)
    assert row["max_attitude"] == pytest.approx(np.abs(yaw).max(), rel=1e-9)
    assert row["final_j1"] == b.rotor_velocity[-1, 0] - a.rotor_velocity[-1, 0]
    assert all(result.table[0][f"max_{state}"] == 0 for state in result.states)


def test_flights_logged_at_other_times_are_compared_in_between():
    coarse, fine = (qc.Simulation("quadrotor", "eigen", dt=dt).run(0.5) for dt in (0.002, 0.0005))
    assert (
        flight_differences.compute_differences(coarse, fine)[:, 0].max() < 1e-5
    )  # of a parabola, by chords
    assert flight_differences.compute_differences(fine, coarse)[:, 0].max() < 1e-12


def test_logs_of_a_comparison_before_are_gone_and_others_stay():
    Path("out/logs").mkdir(parents=True)
    Path("out/logs/01.csv").write_text("of somebody else")
    words = ["compare", "toy.urdf", *FLIGHT, "--out", "out", "--no-plots", "--quiet", "--vary"]
    assert main([*words, "motor.kp=0.03,0.04,0.05"]) == 0
    logs = ["01.csv", "1.csv", "2.csv", "3.csv"]
    assert sorted(path.name for path in Path("out/logs").iterdir()) == logs
    assert main([*words, "motor.kp=0.03,0.04"]) == 0
    assert sorted(path.name for path in Path("out/logs").iterdir()) == logs[:-1]
    assert Path("out/logs/01.csv").read_text() == "of somebody else"


# What fails


def test_a_variant_that_fails_is_a_row_and_the_others_finish(capsys):
    Path("fast.csv").write_text("t,w1\n0,400\n0.05,9000\n")
    flight = [*FLIGHT[:-1], "fast.csv", "--out", "out", "--engine", "ode"]  # which limits a turn
    vary = ["--vary", "motor.kp=1e-4,-1,0.01", "--vary", f"{SLOW}=1,10"]
    assert main(["compare", "toy.urdf", *flight, *vary]) == 3
    out, err = capsys.readouterr()
    reasons = [row["failure"] for row in rows()]
    assert [bool(reason) for reason in reasons] == [False, False, True, True, True, False]
    assert "<kp> '-1' is out of range" in reasons[2]
    assert "t = " in reasons[4]
    assert rows()[4]["final_x"] == ""
    assert "6 flights: 3 flown, 3 failed" in out
    assert all(reason in out for reason in reasons)
    assert err.startswith("error: 3 of 6 flights failed. The first one: no. 3 (kp -1, sim_slow ")
    assert sorted(path.name for path in Path("out/logs").iterdir()) == ["1.csv", "2.csv", "6.csv"]
    content = json.loads(Path("out/comparison.json").read_text())
    assert content["rows"][2]["failure"] == reasons[2]
    assert content["rows"][2]["final_x"] is None
    assert "is out of range" in Path("out/report.html").read_text()


def test_the_first_that_flew_is_what_the_others_are_compared_with():
    result = qc.compare("toy.urdf", {"motor.kp": [-1, 1e-4, 2e-4]}, **SPIN)
    assert result.against == 1
    assert result.logs[0] is None
    assert result.table["max_position"][1] == 0
    assert result.table["max_yaw"][2] > 0
    nothing = qc.compare("toy.urdf", {"motor.kp": [-1, -2]}, **SPIN)
    assert nothing.against is None
    assert (result.refused, nothing.refused) == (1, 2)


@pytest.mark.parametrize("processes", [1, 2])
def test_any_flight_can_be_what_the_others_are_compared_with(processes):
    first = qc.compare("toy.urdf", {"motor.kp": [1e-4, 2e-4, 3e-4]}, **SPIN)
    last = qc.compare(
        "toy.urdf", {"motor.kp": [1e-4, 2e-4, 3e-4]}, against=2, processes=processes, **SPIN
    )
    assert last.against == 2
    for one, other in zip(first.logs, last.logs):
        assert np.array_equal(one.table, other.table)
    assert last.table["max_position"][2] == 0
    assert last.table["final_j1"][0] == -first.table["final_j1"][2] != 0
    assert last.table["final_j1"][1] == first.table["final_j1"][1] - first.table["final_j1"][2]


def test_a_flight_to_compare_with_that_is_none_or_fails_is_said(capsys):
    vary = ["--vary", "motor.kp=1e-4,-1"]
    assert main(["compare", "toy.urdf", *FLIGHT, *vary, "--against", "3"]) == 2
    assert (
        capsys.readouterr().err
        == "error: --against 3: there are only 2 flights. Use a smaller number.\n"
    )
    assert main(["compare", "toy.urdf", *FLIGHT, *vary, "--against", "2"]) == 2
    assert "error: baseline no. 2 is invalid: " in capsys.readouterr().err
    assert main(["compare", "toy.urdf", *FLIGHT, *vary, "--against", "1", "--out", "out"]) == 3
    assert json.loads(Path("out/comparison.json").read_text())["against"] == 1
    Path("fast.csv").write_text("t,w1\n0,400\n0.05,9000\n")
    diverging = [*FLIGHT[:-1], "fast.csv", "--vary", "motor.kp=1e-4,0.05", "--against", "2"]
    diverging += ["--engine", "ode"]  # which limits a turn
    unslowed = [f"--set={name}=1" for name in SLOW.split(",")]
    assert main(["compare", "toy.urdf", *diverging, *unslowed]) == 3
    assert "error: baseline no. 2 failed: " in capsys.readouterr().err


def test_vehicles_are_compared_with_one_of_more_rotors():
    flight = {"engine": "eigen", "duration": 0.01}
    found = qc.compare(["quadrotor", "firefly"], against=1, **flight)
    assert list(found.table["failure"]) == ["", ""]
    assert list(found.states)[-6:] == [f"j{i}" for i in range(1, 7)]
    assert np.isnan(found.table["max_j6"][0]) and found.table["max_j6"][1] == 0
    assert found.table["max_z"][0] > 0


def test_people_read_degrees_and_files_hold_radians(capsys):
    arguments = ["compare", "toy.urdf", *FLIGHT, "--no-plots", "--vary", "motor.kp=1e-4,2e-4"]
    assert main([*arguments, "--out", "out"]) == 0
    degrees = f"{math.degrees(float(rows()[1]['max_attitude'])):.4g}"
    assert float(degrees) > 0
    shown = capsys.readouterr().out
    assert "attitude (deg)" in shown and f"/ {degrees}" in shown
    page = Path("out/report.html").read_text()
    assert f'<td class="number">{degrees}<br>' in page


def test_a_process_that_dies_is_a_case_that_failed():
    def maybe_die(number):
        if number == 2:
            os.kill(os.getpid(), signal.SIGKILL)
        if number == 3:
            raise qc.QuadcoreError("no")
        return number * number

    results = outcomes(maybe_die, range(6), 2)
    assert [results[i] for i in (0, 1, 4, 5)] == [0, 1, 16, 25]
    assert str(results[2]) == "its process was ended by SIGKILL"
    assert str(results[3]) == "no"
    with pytest.raises(RuntimeError, match="ZeroDivisionError"):
        outcomes(lambda number: 1 / number, [1, 0], 2)
