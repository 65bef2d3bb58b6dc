"""Replays of recorded set-points in closed loop."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from processes import run_command, run_refused
from test_player import content_of

import quadcore as qc
from quadcore.formats.recordings import read_recording
from quadcore.studies.fit.fitted_model import FittedModel
from quadcore.studies.fit.prepared import prepare_flight
from quadcore.studies.fit.replay import replay_flight

REAL = Path(__file__).resolve().parents[1] / "data" / "recordings"
MAPPING = """\
format: csv
time: {column: t, unit: s}
position: {columns: [x, y, z], unit: m}
orientation: {columns: [qx, qy, qz, qw], order: xyzw}
rates: {columns: [wx, wy, wz], unit: rad/s}
rotors: {columns: [j1, j2, j3, j4], unit: rad/s}
setpoint: {columns: [sx, sy, sz], unit: m}
setpoint_yaw: {columns: syaw, unit: rad}
"""
FLOWN = "geometric:integral=false"
HEADER = "t,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,j1,j2,j3,j4,sx,sy,sz,syaw"


def find_setpoint(t):
    """Set-points along a circle, without velocities."""
    angle = 1.2 * t
    place = (0.5 * np.cos(angle), 0.5 * np.sin(angle), 2 + 0.1 * np.sin(2 * angle))
    return qc.Reference(position=place, yaw=0.3)


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """A recording of a flight with a controller that sees set-points only, and its mapping."""
    folder = tmp_path_factory.mktemp("flight")
    simulation = qc.Simulation("crazyflie", engine="eigen", spawn=(0.5, 0, 2))
    state = simulation.state.copy()
    state.rotor_velocity = simulation.hover_speed
    simulation.set_state(state)
    controller = qc.controllers.parse(FLOWN)
    log = simulation.run(8, controller=controller, reference=find_setpoint, log_every=10)
    wanted = [find_setpoint(t) for t in log.time]
    rows = np.column_stack(
        [log.table[:, :18], [p.position for p in wanted], [p.yaw for p in wanted]]
    )
    np.savetxt(folder / "flight.csv", rows, delimiter=",", header=HEADER, comments="", fmt="%.9g")
    (folder / "mapping.yaml").write_text(MAPPING)
    return folder


def prepare(folder):
    return prepare_flight(folder / "flight.csv", str(folder / "mapping.yaml"))


def replay(folder, controller):
    fitted = FittedModel([], "crazyflie", "eigen", None, None, None, None, ())
    return replay_flight(fitted, prepare(folder), controller)


def test_a_quick_turn_at_the_start_is_no_lag(flight):
    assert prepare(flight).lags["rates"] == pytest.approx(0, abs=1e-3)


def test_the_controller_of_the_flight_repeats_it(flight):
    found = replay(flight, FLOWN)
    assert found.distances["replay"][0] < 6e-3  # set-points hold for 10 ms
    assert found.distances["set-points"][0] > found.distances["delayed set-points"][0] > 0.015
    assert found.flown.time[-1] == pytest.approx(found.measured.time[-1])


def test_another_controller_is_farther_away(flight):
    same = replay(flight, FLOWN).distances["replay"][0]
    assert replay(flight, f"{FLOWN},kp_xy=4").distances["replay"][0] > 5 * same


def test_predict_prints_and_draws_replays(flight, tmp_path):
    done = run_command(
        "predict", "crazyflie", "--log", flight / "flight.csv", "--mapping",
        flight / "mapping.yaml", "--controller", FLOWN, "--out", tmp_path, "--force",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert re.search(rf"replay with {FLOWN} +0\.00\d+", done.stdout)
    assert re.search(r"set-points delayed by 0\.\d+ s", done.stdout)
    page = (tmp_path / "report.html").read_text()
    assert "Replay of the set-points" in page
    assert [each["name"] for each in content_of(page)["flights"]] == ["measured", "replayed"]


def test_a_recording_without_setpoints_is_refused(flight, tmp_path):
    mapping = tmp_path / "short.yaml"
    mapping.write_text(MAPPING.partition("setpoint:")[0])
    words = ("predict", "crazyflie", "--log", flight / "flight.csv", "--mapping", mapping)
    said = run_refused(*words, "--controller", "geometric", "--out", tmp_path / "p")
    assert "has no set-points. Map setpoint, or remove --controller." in said


def test_setpoints_are_converted_like_positions(tmp_path):
    (tmp_path / "m.yaml").write_text(
        "format: csv\nworld: NED\ntime: {column: t}\nposition: {columns: [n, e, d], unit: m}\n"
        "setpoint: {columns: [n, e, d], unit: m}\nsetpoint_yaw: {columns: yaw, unit: deg}\n"
    )
    (tmp_path / "a.csv").write_text("t,n,e,d,yaw\n0,1,2,-3,0\n1,2,2,-3,90\n")
    given = read_recording(tmp_path / "a.csv", tmp_path / "m.yaml").quantities
    assert (given["setpoint"].values == given["position"].values).all()
    assert given["setpoint"].values[0] == pytest.approx([2, 1, 3])
    assert given["setpoint_yaw"].values[:, 0] == pytest.approx([np.pi / 2, 0])
