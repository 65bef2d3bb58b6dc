"""Built-in worlds, saved worlds, and distances from obstacles."""

from __future__ import annotations

import json
import math
import subprocess
import sys

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main
from quadcore.model.resources import find_root

SAVED = "<state><sim_time>12 340000000</sim_time></state>"


def test_a_saved_world_starts_at_its_time(flown, capsys):
    simulation = flown(world=SAVED)
    assert simulation.time == 12.34
    log = simulation.run(0.01)
    assert log.time[0] == 12.34
    assert log.time[-1] == pytest.approx(12.35)
    assert main(["run", "toy.urdf", "--world", "toy.world", "--duration", "0.01", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["duration"] == pytest.approx(0.01)
    assert result["steps"] == 10


@pytest.mark.parametrize(
    ("name", "count"), [("slalom", 6), ("window", 4), ("landing_platform", 1), ("forest", 150)]
)
def test_a_built_in_world_has_the_ground_and_its_obstacles(name, count):
    world = qc.read_world(name)
    assert world.ground_plane
    assert len(world.obstacles) == count


def test_the_forest_is_what_the_example_writes_for_its_seed():
    def write(seed):
        command = [sys.executable, find_root() / "examples" / "make_forest.py", seed]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    assert write("1") == (find_root() / "worlds" / "forest.world").read_text()
    assert write("2") != write("1")


WALL = (
    '<model name="wall"><static>1</static><pose>1.5 0 10 0 0 0</pose><link name="link">'
    '<collision name="c"><geometry><box><size>0.2 4 4</size></box></geometry></collision></link>'
    "</model>"
)


@pytest.fixture
def walled(tmp_path):
    path = tmp_path / "walled.world"
    path.write_text(f'<sdf version="1.6"><world name="w">{WALL}</world></sdf>')
    return str(path)


@pytest.mark.parametrize("engine", ["ode", "eigen"])
def test_a_course_is_evaluated_with_clearance_and_collisions(engine):
    evaluation = qc.evaluate("geometric", "eight", world="slalom", duration=6, engine=engine)
    (row,) = evaluation.table
    # The path is 0.65 m or more from the axes of the poles, whose radius is 0.1 m.
    assert 0.1 < row["clearance"] < 0.55
    assert row["collisions"] == 0
    (row,) = qc.evaluate("geometric", "hover", duration=0.1, engine="eigen").table
    assert math.isnan(row["clearance"])
    assert math.isnan(row["collisions"])


def test_engines_agree_on_the_time_of_an_impact_at_a_wall(walled):
    impacts = []
    for engine in ("ode", "eigen"):
        simulation = qc.Simulation("quadrotor", engine=engine, world=walled)
        log = simulation.run(2.0, controller="geometric", reference="ramp:time=0.1")
        jumps = np.abs(np.diff(log.linear_velocity[:, 0]))
        impacts.append(log.time[1 + np.argmax(jumps > 0.05)])
        assert log.position[:, 0].max() < 1.4  # the near side of the wall
    assert impacts[0] > 0.5
    assert impacts[0] == pytest.approx(impacts[1], abs=0.01)


def test_a_run_tells_where_it_collides(walled, capsys):
    command = [
        "run",
        "quadrotor",
        "--controller",
        "geometric",
        "--reference",
        "ramp:time=0.1",
        "--world",
        walled,
    ]
    assert main([*command, "--duration", "2", "--engine", "gazebo11", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["clearance"] < 1e-4
    first = result["collisions"][0]
    assert first["obstacle"] == "wall"
    assert 0.5 < first["time"] < 1.6
    assert 0.9 < first["position"][0] < 1.4
    assert main([*command, "--duration", "0.5"]) == 0
    assert "m from wall at t = 0." in capsys.readouterr().out
