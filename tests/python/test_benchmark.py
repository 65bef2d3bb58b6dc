"""The benchmark: its definition, and the results that the repository keeps."""

from __future__ import annotations

import csv
import hashlib
import json
import re
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.benchmark.definition import Definition
from quadcore.studies.benchmark.output import make_results
from quadcore.studies.benchmark.scores import Score, compute_scores, format_score

ROOT = Path(__file__).resolve().parents[2]
PART = ["benchmark", "--vehicle", "hummingbird", "--category", "delay"]
MINE = """
import quadcore as qc

class Mine:
    def __init__(self, kp=7.0):
        self.geometric = qc.controllers.geometric(kp_xy=kp)

    def reset(self, vehicle):
        self.geometric.reset(vehicle)

    def __call__(self, t, state, reference):
        return self.geometric(t, state, reference)
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def read(path):
    with open(path) as stream:
        return list(csv.DictReader(stream))


def kept():
    return read(Definition().results)


def test_references_reach_15_m_s_and_60_degrees():
    fast = Definition()
    for label in ("circle_fast", "eight_fast", "gates_fast"):
        reference = qc.references.parse(fast.references[label])
        wanted = reference.at(np.linspace(0, fast.duration, 2000))
        force = wanted.acceleration + np.array([0, 0, 9.81])
        tilt = np.degrees(np.arccos(force[:, 2] / np.linalg.norm(force, axis=1))).max()
        assert tilt == pytest.approx(60, abs=0.2)
        assert np.linalg.norm(wanted.velocity, axis=1).max() == pytest.approx(14, abs=1.5)


def test_every_file_of_a_version_is_used():
    given = Definition()
    used = {given.find_scenario(c, vehicle) for c in given.conditions for vehicle in given.vehicles}
    used |= {Path(text.partition(":")[2]) for text in given.references.values()}
    files = {path for path in given.folder.glob("*.*") if path.name != "benchmark.yaml"}
    assert files == {path for path in used if path is not None and path.is_file()}


def test_a_part_repeats_the_results_of_the_repository():
    found = qc.benchmark(["geometric", "indi"], vehicles="quadrotor", categories=["fast", "delay"])
    expected = [
        row
        for row in kept()
        if row["controller"] in ("geometric", "indi")
        and row["model"] == "quadrotor"
        and row["category"] in ("fast", "delay")
    ]
    assert sorted(map(str, csv.DictReader(make_results(found).decode().splitlines()))) == sorted(
        map(str, expected)
    )
    assert not found.is_complete


def test_the_page_has_the_scores_of_the_results():
    rows = kept()
    for row in rows:
        row.update(flights=int(row["flights"]), failed=int(row["failed"]))
        row["rms_position"] = float(row["rms_position"] or "nan")
    text = (ROOT / "docs/benchmark.md").read_text()
    for score in compute_scores(rows):
        line = re.search(rf"^\| `{score.controller}` \|.*$", text, re.M)
        assert f"| {format_score(score)} |" in line.group(), score


def test_the_results_are_of_all_flights_of_the_version():
    given = Definition()
    cells = {(row["model"], row["scenario"], row["reference"]) for row in kept()}
    assert cells == {
        (vehicle, each.name, reference)
        for vehicle in given.vehicles
        for each in given.conditions
        for reference in each.references
    }
    general = set(qc.controllers.NAMES) - set(qc.controllers.FIRMWARE)
    assert {row["controller"] for row in kept()} == general


def test_a_score_is_the_median_and_a_failure_is_infinite():
    names = {"controller": "a", "category": "fast", "flights": 2}
    cells = [{**names, "failed": 0, "rms_position": x} for x in (0.1, 0.3, 0.2)]
    assert compute_scores(cells) == [Score("a", "fast", 0.2, 6, 0)]
    cells[0]["failed"] = cells[1]["failed"] = 1
    (score,) = compute_scores(cells)
    assert score.error == float("inf") and format_score(score) == "2 of 6 failed"


def test_a_result_names_the_source_of_the_controller_and_repeats_bit_for_bit(capsys):
    Path("mine.py").write_text(MINE)
    for out in ("one", "two"):
        words = [*PART, "--controller", "mine.py:Mine:kp=6,geometric:kp_xy=6", "--out", out]
        assert main([*words, "--jobs", "1" if out == "one" else "2"]) == 0
    for name in ("results.csv", "flights.csv", "scores.csv", "benchmark.json", "comparison.tex"):
        assert Path("one", name).read_bytes() == Path("two", name).read_bytes()
    record = json.loads(Path("one/benchmark.json").read_text())
    mine = hashlib.sha256(Path("mine.py").read_bytes()).hexdigest()
    assert [each["sha256"] for each in record["controllers"]] == [mine, None]
    assert record["controllers"][0]["name"] == "mine.py:Mine:kp=6"
    assert record["benchmark"] == "v1" and record["definition"] == Definition().digest
    assert record["quadcore"] == qc.__version__ and record["machine"]["processor"]
    assert record["built_in"][0]["parameters"]["kp_xy"] == 6
    assert not record["is_complete"]
    own, same = read("one/results.csv")[:3], read("one/results.csv")[3:]
    assert [row["rms_position"] for row in own] == [row["rms_position"] for row in same]
    assert "is a part of v1" in capsys.readouterr().out


def test_wrong_names_are_bad_input(capsys):
    for words, message in (
        (["v9"], "benchmark 'v9' does not exist"),
        (["--vehicle", "crazyfly"], "vehicle 'crazyfly' does not exist. Did you mean 'crazyflie'?"),
        (["--category", "slwo"], "category 'slwo' does not exist. Did you mean 'slow'?"),
        (["--controller", "pdd"], "controller 'pdd' does not exist"),
    ):
        assert main(["benchmark", *words]) == 2
        assert message in capsys.readouterr().err
