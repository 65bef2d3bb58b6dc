"""``quadcore run`` with several vehicles in one world."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import quadcore as qc
from quadcore.cli import main

pytestmark = pytest.mark.usefixtures("in_empty_folder")

COMMON = ["run", "--world", "default", "--duration", "0.5", "--no-plots"]
LOW = ["--model", "quadrotor", "--spawn", "0,0,2", "--controller", "geometric"]
HIGH = ["--model", "quadrotor", "--spawn", "0,0,4"]


def refuse(capsys, *arguments):
    assert main(arguments) == 2
    return capsys.readouterr().err


def test_each_vehicle_has_a_folder_and_one_page_shows_all():
    assert main([*COMMON, "--quiet", "--out", "out", *LOW, *HIGH]) == 0
    logs = {name: qc.Log.of_file(f"out/{name}/log.csv") for name in ("quadrotor", "quadrotor_2")}
    alone = qc.Simulation("quadrotor", world="default.world", spawn=(0, 0, 4), seed=1).run(0.5)
    assert logs["quadrotor_2"].position.tobytes() == alone.position.tobytes()
    assert abs(logs["quadrotor"].position[-1, 2] - 2) < 0.2
    flights = json.loads(Path("out/run.json").read_text())["flights"]
    assert [each["log"] for each in flights] == ["quadrotor/log.csv", "quadrotor_2/log.csv"]
    page = Path("out/report.html").read_text()
    assert "quadrotor_2" in page
    assert Path("out/quadrotor_2/report.html").exists()


def test_the_summary_names_the_nearest_vehicle_and_collisions(capsys):
    falling = [*LOW[:4], *HIGH[:2], "--spawn", "0,0,0.1"]
    assert main([*COMMON, "--json", "--duration", "1.2", *falling]) == 0
    above, below = json.loads(capsys.readouterr().out)["vehicles"].values()
    assert above["vehicle_clearance"] == below["vehicle_clearance"] < 1e-4
    assert above["nearest_vehicle"]["obstacle"] == "quadrotor_2"
    assert len(below["vehicle_collisions"]) >= 1
    assert main([*COMMON, *LOW, *HIGH]) == 0
    out = capsys.readouterr().out
    assert "nearest vehicle" in out
    assert "collisions with vehicles  0" in out


def test_a_vehicle_has_the_name_that_is_given_and_eigen_states_what_it_leaves_out(capsys):
    named = [*COMMON, "--json", "--engine", "eigen", *LOW, "--name", "low", *HIGH, "--name", "high"]
    assert main(named) == 0
    captured = capsys.readouterr()
    vehicles = json.loads(captured.out)["vehicles"]
    assert list(vehicles) == ["low", "high"]
    assert vehicles["low"]["nearest_vehicle"]["obstacle"] == "high"
    assert vehicles["low"]["unsimulated"] == ["contact between vehicles"]
    assert "warning: the vehicles pass through each other" in captured.err
    assert "--name: names one of several vehicles" in refuse(capsys, "run", "iris", "--name", "a")


def test_vehicles_need_places_and_options_of_their_own(capsys):
    same = refuse(capsys, *COMMON, *LOW, *LOW)
    assert "vehicles 'quadrotor' and 'quadrotor_2' start at the same place" in same
    world = refuse(capsys, *COMMON, *LOW, *HIGH, "--duration", "2")
    assert "--duration: is the same for all vehicles" in world
    assert "MODEL and --model exclude each other" in refuse(capsys, "run", "iris", *LOW)
    assert "--live: is for one vehicle" in refuse(capsys, *COMMON, "--live", *LOW, *HIGH)
    twice = refuse(capsys, *COMMON, "--log", "a.csv", *LOW, *HIGH)
    assert "a.csv: would be written twice. Give --log after each --model." in twice
    assert "arguments are required: MODEL" in refuse(capsys, *COMMON)
