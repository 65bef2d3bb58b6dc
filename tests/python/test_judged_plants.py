"""Recordings of other plants, judged against the mathematical model and the engines."""

import csv

import numpy as np
import pytest
from processes import run_command, run_refused

import quadcore as qc
from quadcore.formats.bag_messages import ARRAY, Messages

MOVING = {"linear_velocity": [1.0, -0.5, 0.2], "rotor_velocity": [47.0, -46, 47, -46]}


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """A flight of gazebo11 that begins late, moving, and with the commands beside it."""
    simulation = qc.Simulation("quadrotor", dt=0.001)
    state = simulation.state.copy()
    state.time = 3.0
    for name, values in MOVING.items():
        setattr(state, name, np.array(values))
    simulation.set_state(state)
    commands = [[3.0, 480, -470, 475, -470], [3.2, 470, -480, 470, -475]]
    log = simulation.run(0.5, commands, topics=["vel_cmd"])
    folder = tmp_path_factory.mktemp("recordings")
    for suffix in ("csv", "mat", "bag"):
        log.to_file(folder / f"flight.{suffix}")
    np.savetxt(folder / "bare.csv", log.table, delimiter=",", header=",".join(log.columns),
               comments="", fmt="%.17g")  # fmt: skip
    np.savetxt(folder / "late.csv", [[3.1, 480, -470, 475, -470]], delimiter=",",
               header="t,w1,w2,w3,w4", comments="")  # fmt: skip
    return folder


def largest(out):
    rows = list(csv.DictReader((out / "plant.csv").open()))
    return {(row["plant"], row["state"]): float(row["max"]) for row in rows}


@pytest.mark.parametrize("suffix", ["csv", "mat", "bag"])
def test_a_recording_is_nearest_to_the_engine_that_flew_it(suffix, recording, tmp_path):
    done = run_command(
        "validate", "--plant", str(recording / f"flight.{suffix}"), "--out", str(tmp_path)
    )
    assert done.returncode == 0, done.stderr
    assert "maximum difference from" in done.stdout and "chapter 2" in done.stdout
    apart = largest(tmp_path)
    # The start's orientation is normalised anew, no more.
    assert apart["gazebo11", "position"] < 1e-12 < apart["eigen", "position"] < 0.1
    assert apart["chapter 2", "position"] < 0.1
    assert apart["gazebo11", "j1"] < 1e-9


def test_a_wrong_model_is_far_from_the_recording(recording, tmp_path):
    done = run_command(
        "validate", "--plant", str(recording / "flight.csv"), "--engine", "eigen",
        "--out", str(tmp_path), "--set", "drone_plugin.rotorThrustCoeff=5e-6",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    apart = largest(tmp_path)
    assert apart["eigen", "z"] > 0.1 and apart["chapter 2", "z"] > 0.1
    assert ("gazebo11", "z") not in apart


def test_a_bag_of_the_thesis_lacks_the_rotors_and_says_so(tmp_path):
    """Its Gazebo sent odom and took vel_cmd, no more."""
    writer = pytest.importorskip("rosbags.rosbag1").Writer
    messages, state = Messages(), np.array([0, 0, 1, 0, 0, 0, 1, *[0] * 6], dtype=float)
    with writer(tmp_path / "thesis.bag") as bag:
        odometry = bag.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=messages.store)
        commands = bag.add_connection("/quadrotor/vel_cmd", ARRAY, typestore=messages.store)
        stamp = messages._stamp(0.0)
        bag.write(odometry, 1, messages._odometry(stamp, state, [0.0] * 4))
        speeds = np.array([480.0, -480, 480, -480])
        bag.write(commands, 1, messages.make_array(speeds, messages.make_layout(["w"], 4)))
    found = run_refused("validate", "--plant", str(tmp_path / "thesis.bag"))
    assert "topics that end in ground_truth/odometry: none" in found
    assert "or give a .csv or .mat file with the columns of a log." in found


def test_what_cannot_be_judged_is_one_line(recording):
    bare = str(recording / "bare.csv")
    assert "has no topic vel_cmd. Give the --commands" in run_refused("validate", "--plant", bare)
    late = ("--commands", str(recording / "late.csv"))
    assert "begins at t = 3, the commands at 3.1" in run_refused("validate", "--plant", bare, *late)
    found = run_refused("validate", "hexarotor", "--plant", str(recording / "flight.csv"))
    assert "has 4 rotors, the model 6" in found
    found = run_refused("validate", "--plant", bare, "--sim-slow", "8")
    assert "--plant is one flight. Give its --sim-slow with --set" in found
