"""Computation time of controllers: on the page, and as a delay of the command."""

from __future__ import annotations

import csv
import json
import re
import sys
from pathlib import Path

import pytest

import quadcore as qc
from quadcore.cli import main

OWN = """
import time
import quadcore as qc

class Slow:
    delay = 0.001
    def reset(self, vehicle):
        self.inner = qc.controllers.geometric()
        self.inner.reset(vehicle)
    def __call__(self, t, state, reference):
        time.sleep(0.003)
        return self.inner(t, state, reference)

class Fails(Slow):
    def __call__(self, t, state, reference):
        raise ValueError("no idea")
"""
FLIGHT = ["--reference", "circle", "--duration", "0.2", "--xacro", "sim_slow:=1", "--no-plots"]


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN)
    monkeypatch.delitem(sys.modules, "own", raising=False)


def read(name="out"):
    return json.loads(Path(name, "evaluation.json").read_text())


def rows(name="out"):
    with open(f"{name}/table.csv") as stream:
        return list(csv.DictReader(stream))


def test_a_given_time_is_a_further_delay_of_every_controller():
    words = ["evaluate", "--controller", "geometric:delay=0.002,own.py:Slow", *FLIGHT, "--quiet"]
    assert main([*words, "--computation-time", "0.004", "--out", "out"]) == 0
    assert [row["delay"] for row in read()["flights"]] == pytest.approx([0.006, 0.005])
    delayed = [*words, "--out", "delayed"]
    delayed[2] = "geometric:delay=0.006,own.py:Slow:delay=0.005"
    assert main(delayed) == 0
    for one, other in zip(rows(), rows("delayed")):
        assert one["rms_position"] == other["rms_position"]


def test_the_time_is_not_added_again_for_each_seed():
    def hover(t, state, reference):
        return [471.0, -471.0, 471.0, -471.0]

    hover.delay = 0.002
    given = {"seeds": 3, "duration": 0.1, "xacro_args": {"sim_slow": 1}}
    found = qc.evaluate(hover, "hover", computation_time=0.004, **given)
    assert [outcome.delay for outcome in found.outcomes] == pytest.approx([0.006] * 3)


def test_a_measured_time_delays_the_command_and_is_stated(capsys):
    controllers = "geometric,own.py:Slow,own.py:Fails"
    words = ["evaluate", "--controller", controllers, *FLIGHT, "--out", "out"]
    assert main([*words, "--computation-time", "measured"]) == 3
    content = read()
    times = content["plan"]["computation_times"]
    assert 0 < times["geometric"] < 0.003 < times["own.py:Slow"] < 0.2
    delays = [row["delay"] for row in content["flights"]]
    assert delays[1] == pytest.approx(0.001 + times["own.py:Slow"])
    output = " ".join(capsys.readouterr().out.split())
    page = Path("out/report.html").read_text()
    for text in (
        "Commands are delayed by computation times measured on this machine",
        "The computation time of own.py:Fails is not measured, because its flight failed.",
    ):
        assert text in output and text in page


def test_the_page_has_the_times_of_own_controllers_only():
    words = ["evaluate", "--controller", "geometric,own.py:Slow", *FLIGHT, "--quiet"]
    assert main([*words, "--out", "out"]) == 0
    assert "computation_times" not in read()["plan"]
    page = Path("out/report.html").read_text()
    section = page.rpartition("Computation time of your own controllers")[2]
    section = section.partition("</table>")[0]
    assert "geometric" not in section
    cells = re.findall("<td>(.*?)</td>", section)
    assert cells[:4] == ["own.py:Slow", "quadrotor", "eigen", "1"]
    median, slow, share = map(float, cells[4:])
    assert 3 < median <= slow and share == pytest.approx(slow * 0.5, rel=0.01)


def test_a_wrong_time_is_bad_input():
    with pytest.raises(qc.InputError, match="Give seconds, at least 0, or 'measured'"):
        qc.evaluate("geometric", "hover", computation_time=-1.0)
