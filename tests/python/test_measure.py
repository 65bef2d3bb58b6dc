"""Recorded flights are measured as simulated ones are."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from recording_files import make_ulog
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.cli import main

FLIGHT = {"engine": "eigen", "xacro_args": {"sim_slow": 1}, "duration": 4}
OF_CALLS = ("saturated", "command_effort", "effort")
"""Metrics that need more than the rows of a log."""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def fly(controller="pd", reference="circle", log_every=10, duration=4):
    """The flight of `evaluate`, as a log without the columns of the reference."""
    plan = qc.FlightPlan.of(
        "quadrotor",
        engine="eigen",
        xacro_args={"sim_slow": 1},
        controller=qc.controllers.parse(controller, "quadrotor"),
        reference=qc.references.parse(reference),
        on_reference=True,
        log_every=log_every,
        duration=duration,
    )
    return qc.Log(plan.fly().table)


def simulated(controller="pd", reference="circle"):
    return qc.evaluate(controller, reference, **FLIGHT).table[0]


def measured(logs, reference="circle", **options):
    return qc.measure(logs, reference, xacro_args={"sim_slow": 1}, **options)


def check_equal(measures, expected, but):
    for name, value in expected.items():
        if name not in ("engine", "controller", *but):
            assert measures[name] == value or _are_missing(measures[name], value), name


def _are_missing(*values):
    return all(isinstance(value, float) and math.isnan(value) for value in values)


@pytest.mark.parametrize("suffix", [".csv", ".mat", ".bag", ".ros2"])
@pytest.mark.parametrize("reference", ["circle", "step"])
def test_the_log_of_a_simulated_flight_has_its_metrics(suffix, reference):
    fly(reference=reference).to_file(f"flight{suffix}")
    found = measured(f"flight{suffix}", reference)
    check_equal(found.table[0], simulated(reference=reference), OF_CALLS)
    assert found.table[0]["engine"] == "recorded"
    assert found.table[0]["effort"] == pytest.approx(simulated(reference=reference)["effort"], 0.02)


def test_other_rows_change_metrics_by_no_more_than_happens_between_rows():
    expected = simulated()
    for every in (1, 40):
        found = measured(fly(log_every=every)).table[0]
        for name in ("rms_position", "max_position", "iae_position", "energy", "max_speed"):
            assert found[name] == pytest.approx(expected[name], rel=0.01), (every, name)


def test_recorded_and_simulated_flights_share_table_and_page():
    fly().to_file("flight.csv")
    words = ["pd=flight.csv", "flight.csv", "--reference", "circle", "--controller", "pd,geometric"]
    assert main(["measure", *words, "--xacro", "sim_slow:=1", "--out", "out", "--no-plots"]) == 0
    with open("out/table.csv") as stream:
        rows = list(csv.DictReader(stream))
    names = [(row["controller"], row["engine"]) for row in rows]
    of_logs = [("pd", "recorded"), ("flight.csv", "recorded")]
    assert names == [("pd", "eigen"), ("geometric", "eigen"), *of_logs]
    assert len({row["rms_position"] for row in (rows[0], *rows[2:])}) == 1
    content = json.loads(Path("out/evaluation.json").read_text())
    assert [each["begin"] for each in content["plan"]["recordings"]] == [0, 0]
    assert content["plan"]["duration"] == 4
    page = Path("out/report.html").read_text()
    assert "the reference begins at 0 s of the log, as given; 401 rows every 0.01 s" in page


def shifted(log, seconds):
    """The flight after some time at its start."""
    waiting = np.repeat(log.table[:1], round(seconds / 0.01), axis=0)
    waiting[:, 0] = np.arange(len(waiting)) * 0.01
    table = log.table.copy()
    table[:, 0] += seconds
    return qc.Log(np.vstack([waiting, table]))


def test_the_alignment_is_as_given_or_found():
    log = fly("geometric", duration=6)
    expected = measured(log).table[0]
    late = shifted(log, 1.5)
    given = measured(late, align=1.5).table[0]
    for name in ("rms_position", "iae_position", "max_yaw"):
        assert given[name] == pytest.approx(expected[name], rel=1e-9)
    found = measured({"a": late, "b": qc.Log(log.table[100:])}, align="find")
    assert [row["failure"] for row in found.table] == ["", ""]
    assert all(row["rms_position"] < 1e-3 for row in found.table)
    late = measured({"a": late}, align=1.0).table[0]
    assert late["rms_position"] > 0.5


def test_a_log_that_begins_within_the_reference_is_aligned_by_a_negative_time():
    log = fly("geometric", duration=6)
    part = log.table[100:].copy()
    part[:, 0] -= 1.0
    assert measured(qc.Log(part), align=-1).table[0]["rms_position"] < 1e-3


def test_uneven_rows_are_interpolated():
    log = fly(log_every=5)
    kept = np.random.default_rng(1).random(len(log)) < 0.6
    kept[[0, -1]] = True
    found = measured(qc.Log(log.table[kept])).table[0]
    for name in ("rms_position", "max_position", "max_tilt", "iae_position"):
        assert found[name] == pytest.approx(simulated()[name], rel=0.01)


def test_a_ulog_in_ned_is_measured_without_its_missing_rotors():
    log = fly("geometric")
    world = Rotation.from_matrix([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
    body = Rotation.from_matrix(np.diag([1, -1, -1]))
    turned = (world * Rotation.from_quat(log.orientation) * body).as_quat()[:, [3, 0, 1, 2]]
    stamps = [int(t * 1e6) for t in log.time]
    where = log.position[:, [1, 0, 2]] * (1, 1, -1)
    speed = log.linear_velocity[:, [1, 0, 2]] * (1, 1, -1)
    rates = log.angular_velocity * (1, -1, -1)
    fields = ["float x", "float y", "float z", "float vx", "float vy", "float vz"]
    topics = {
        "vehicle_local_position": (fields, rows(stamps, where, speed)),
        "vehicle_attitude": (["float[4] q"], rows(stamps, turned)),
        "vehicle_angular_velocity": (["float[3] xyz"], rows(stamps, rates)),
    }
    Path("flight.ulg").write_bytes(make_ulog(topics))
    found, expected = measured("flight.ulg").table[0], simulated("geometric")
    assert math.isnan(found["effort"]) and math.isnan(found["energy"])
    assert found["rms_position"] == pytest.approx(expected["rms_position"], abs=1e-6)
    for name in ("max_yaw", "max_tilt", "max_speed"):
        assert found[name] == pytest.approx(expected[name], abs=1e-5)


def rows(stamps, *values):
    return [(stamp, *row) for stamp, row in zip(stamps, np.hstack(values).tolist())]


def test_logs_of_one_label_are_repetitions():
    log = fly()
    moved = log.table.copy()
    moved[:, 1] += 0.01
    found = measured({"pd": [log, qc.Log(moved)], "other": log})
    assert [(row["controller"], row["seed"]) for row in found.table] == [
        ("pd", 0),
        ("pd", 1),
        ("other", 0),
    ]
    first = found.groups[0]
    assert first["flights"] == 2 and first["low_rms_position"] < first["mean_rms_position"]
    assert found.groups[1]["flights"] == 1


def test_a_flight_far_from_its_reference_failed(capsys):
    fly().to_file("flight.csv")
    assert main(["measure", "flight.csv", "--reference", "hover:x=9", "--quiet"]) == 3
    assert "flight.csv on hover:x=9 in recorded, seed 0: lost at t = 0" in capsys.readouterr().err


def test_wrong_input_is_one_line(capsys):
    fly().to_file("flight.csv")
    Path("empty.csv").write_text("a,b\n1,2\n")
    for words, message in (
        (["flight.csv"], "no reference is named"),
        (["flight.csv", "--reference", "circle", "--align", "0,1"], "2 alignments are given for 1"),
        (["flight.csv", "--reference", "circle", "--align", "fin"], "'fin' is neither a number"),
        (["flight.csv", "--reference", "circle", "--align", "9"], "no rows are left after"),
        (["flight.csv", "--reference", "circle", "--model", "hexarotor"], "has 4 rotors"),
        (["empty.csv", "--reference", "circle"], "empty.csv"),
        (["missing.csv", "--reference", "circle"], "missing.csv"),
    ):  # fmt: skip
        assert main(["measure", *words]) == 2, words
        assert message in capsys.readouterr().err


def test_constraints_and_further_metrics_are_those_of_simulated_flights():
    criteria = {"constraints": {"tilt": 0.3}, "metrics": ["attitude"], "failure_distance": 0.5}
    expected = qc.evaluate("pd", "circle", **FLIGHT, **criteria).table[0]
    check_equal(measured(fly(), **criteria).table[0], expected, OF_CALLS)
    assert expected["tilt_violation"] > 0
