"""RotorS' modules against the original ones, recorded in real Gazebo 11.

tests/data/rotors holds the first seconds of recordings (scripts/thin_rotors_recordings.py), flown
by the shipped vehicles, which have RotorS' numbers. Where the environment variable
QUADCORE_ROTORS_RECORDINGS names a folder of whole recordings, those are flown too, by the vehicles
that lie there.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc

# Firefly, iris and ardrone have an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

DATA = Path(__file__).resolve().parents[1] / "data" / "rotors"
WHOLE = [Path(p) for p in (os.environ.get("QUADCORE_ROTORS_RECORDINGS"),) if p]
CASES = [c.parent for f in (DATA, *WHOLE) for c in sorted(f.glob("*/record.csv.gz"))]

WORLD = """\
<sdf version="1.6">
  <world name="default">
    <physics type="ode">
      <max_step_size>{step}</max_step_size>
      <ode><solver><type>{solver}</type><iters>{iters}</iters></solver></ode>
    </physics>
    {ground}
  </world>
</sdf>
"""
GROUND = "<include><uri>model://ground_plane</uri></include>"
FROM_THE_GROUND = ("G1_firefly_takeoff_rotorsworld", "G4_iris_takeoff_plain")


def name_of(case):
    return case.name if DATA in case.parents else f"whole-{case.name}"


def params(case):
    return dict(line.split(" ", 1) for line in (case / "params.txt").read_text().splitlines())


def rows(path):
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


def shipped(case, case_parameters, folder):
    """The vehicle and the world of a case, written anew."""
    world = folder / "case.world"
    ground = GROUND if case.name in FROM_THE_GROUND else ""
    world.write_text(WORLD.format(**case_parameters, ground=ground))
    arguments = {
        "slowdown": case_parameters["slow"],
        "sensors": str(case_parameters["imu_link"] != "None").lower(),
    }
    parameters = {}
    if case.name == "D_hummingbird_rolling":
        parameters = {f"motor_{i}.rollingMomentCoefficient": 0.001 for i in range(4)}
    spawn = case_parameters["spawn"].split()
    return qc.Simulation(
        case_parameters["model"],
        world=world,
        spawn=spawn,
        xacro_args=arguments,
        parameters=parameters,
    )


def bar(case, case_parameters):
    """How far from its recording a flight may end, m."""
    if case.name in FROM_THE_GROUND:
        return 1e-7
    if float(case_parameters["step"]) == 0.01:
        return 1e-10  # as in RotorS' own world
    if case_parameters["iters"] == "10":
        return 1e-9
    return 1e-8


def test_every_vehicle_that_was_recorded_is_flown():
    models = {params(case)["model"] for case in CASES if DATA in case.parents}
    assert models == {"firefly", "hummingbird", "iris", "neo11", "pelican"}


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_a_vehicle_of_rotors_flies_as_recorded(case, tmp_path):
    case_parameters = params(case)
    if DATA in case.parents:
        simulation = shipped(case, case_parameters, tmp_path)
        commands = rows(case / "commands.csv.gz")
    else:
        spawn = case_parameters["spawn"].split()
        simulation = qc.Simulation(case / "model.urdf", world=case / "case.world", spawn=spawn)
        commands = case / "commands.csv"
    recorded = rows(case / "record.csv.gz")
    log = simulation.run(recorded[-1, 0], commands=commands)
    at = np.rint(recorded[:, 0] / simulation.dt).astype(int)
    apart = np.linalg.norm(log.position[at] - recorded[:, 1:4], axis=1).max()
    assert apart < bar(case, case_parameters)
    # Speeds show differences of short flights more sharply than positions do.
    n = simulation.rotor_count
    assert np.abs(log.rotor_velocity[at] - recorded[:, 14 : 14 + n]).max() < 1e-5


def test_the_inertial_unit_errs_as_that_of_rotors_which_seeds_nothing():
    case_parameters = rows(DATA / "imu_errors.csv.gz")
    simulation = qc.Simulation("firefly", spawn=(0, 0, 10), seed=7)
    log = simulation.run(case_parameters[-1, 0], topics=["imu", "ground_truth_imu"])
    at = np.rint(case_parameters[:, 0] / simulation.dt).astype(int)

    def errors(message, walks):
        fields = np.array([message[f] for f in ("ax", "ay", "az", "wx", "wy", "wz")]).T[at]
        fields[:, :3] -= np.where(
            case_parameters[:, :1] < 0.0015, [0, 0, 9.8], [0, 0, 0]
        )  # then it falls
        return fields - walks

    assert np.allclose(log.topics["imu"]["stamp"][at], case_parameters[:, 0], rtol=0, atol=1e-12)
    assert np.abs(errors(log.topics["imu"], case_parameters[:, 1:])).max() < 1e-8
    # That without errors walks, too: RotorS does not read the tag with which it says otherwise.
    walk = errors(log.topics["ground_truth_imu"], 0)
    assert np.abs(walk[:, :3]).max() < 1e-8
    assert 1e-7 < np.abs(walk[:, 3:]).max() < 1e-4
