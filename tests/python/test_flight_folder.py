"""Folders of studies play: their flights have logs, models and worlds."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from test_player import content_of

import quadcore as qc
from quadcore.cli import main
from quadcore.report.colours import choose_colour

FLY = ("--engine", "eigen", "--duration", "0.2", "--quiet", "--no-plots", "--out", "out")
GUIDED = ("--controller", "geometric", "--reference", "circle")
WALL = """<sdf version="1.5"><world name="hall"><model name="wall"><static>true</static>
<pose>5 1 2 0 0 0.5</pose><link name="body"><collision name="side"><geometry><box>
<size>0.2 4 3</size></box></geometry></collision></link></model></world></sdf>
"""
COMMANDS = {
    "run": ("run", "quadrotor", *GUIDED, *FLY),
    "compare": ("compare", "quadrotor", "hexarotor", *GUIDED, *FLY),
    "evaluate": ("evaluate", *GUIDED, *FLY),
    "sweep": ("sweep", *GUIDED, "--vary", "frame.mass=0.9,1,1.1", *FLY),
    "validate": ("validate", "--sim-slow", "1", "--drag", "none", *FLY[2:]),
}
FLIGHTS = {"run": 1, "compare": 2, "evaluate": 1, "sweep": 2, "validate": 4}


@pytest.fixture(autouse=True)
def in_folder(tmp_path, monkeypatch):
    """Run every test in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    Path("hall.world").write_text(WALL)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_folder_plays_with_its_vehicles_and_obstacles(name):
    world = [] if name == "evaluate" else ["--world", "hall.world"]  # eigen has no obstacles
    words = [*COMMANDS[name], *world]
    if name in ("run", "compare", "sweep"):
        words[words.index("eigen")] = "ode"
    if name == "validate":
        words = [*COMMANDS[name]]
    assert main(words) == 0
    assert main(["play", "out", "-o", "page.html", "--quiet"]) == 0
    content = content_of(Path("page.html").read_text())
    listed = json.loads(Path("out/run.json").read_text())
    assert listed["command"].startswith(f"quadcore {name} ") and listed["quadcore"]
    assert len(content["flights"]) == FLIGHTS[name] == len(listed["flights"])
    vehicles = {flight["vehicle"] for flight in listed["flights"]}
    bodies = [len(vehicle["bodies"]) for vehicle in content["vehicles"]]
    assert sorted(bodies) == sorted(1 + (6 if each == "hexarotor" else 4) for each in vehicles)
    if "hall.world" in words:
        (wall,) = content["obstacles"]
        assert wall["size"] == [0.2, 4, 3] and wall["pose"][3::4][:3] == [5, 1, 2]
    for flight in listed["flights"]:
        model = qc.read_model(f"out/{flight['model']}")
        assert model.name == flight["vehicle"]
        assert len(qc.Log.of_file(f"out/{flight['log']}")) > 2


def test_flights_of_an_evaluation_keep_names_colours_and_events():
    words = ["evaluate", "--controller", "pd,geometric", "--reference", "circle", *FLY]
    assert main(words) == 0
    assert main(["play", "out", "-o", "page.html", "--quiet"]) == 0
    flights = content_of(Path("page.html").read_text())["flights"]
    assert [flight["name"] for flight in flights] == ["circle: pd", "circle: geometric"]
    assert main(["play", "out/logs/2.csv", "-o", "one.html", "--quiet"]) == 0
    (one,) = content_of(Path("one.html").read_text())["flights"]
    assert one["colour"] == choose_colour(1) == flights[1]["colour"]
    assert one["speed_limit"] == 90.0


def test_the_logs_of_a_sweep_are_those_of_its_rows():
    assert main([*COMMANDS["sweep"]]) == 0
    flights = json.loads(Path("out/run.json").read_text())["flights"]
    rows = np.genfromtxt("out/table.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    order = np.argsort(rows["rms_position"], kind="stable")
    assert [flight["name"] for flight in flights] == [
        f"row {order[1]}, median rms_position",
        f"row {order[2]}, maximum rms_position",
    ]
    for flight, row in zip(flights, (order[1], order[2])):
        log = qc.Log.of_file(f"out/{flight['log']}")
        wanted = np.column_stack([log.topics["reference"][axis] for axis in "xyz"])
        error = np.sqrt(np.mean(np.sum((log.position - wanted) ** 2, axis=1)))
        assert error == pytest.approx(rows["rms_position"][row], rel=1e-6)


def test_the_next_study_removes_its_logs_and_models_and_no_other_file():
    words = ["evaluate", "--controller", "pd,geometric", "--reference", "circle", *FLY]
    assert main(words) == 0
    Path("out/logs/mine.csv").write_text("mine")
    assert main(["evaluate", "--controller", "pd", "--reference", "circle", *FLY]) == 0
    assert sorted(path.name for path in Path("out/logs").iterdir()) == ["1.csv", "mine.csv"]


def test_damaged_lists_are_refused(capsys):
    Path("out").mkdir()
    Path("out/run.json").write_text('{"worlds": [], "flights": [{}]}')
    assert main(["play", "out", "-o", "page.html"]) == 2
    assert "out/run.json: does not list flights ('name')" in capsys.readouterr().err
