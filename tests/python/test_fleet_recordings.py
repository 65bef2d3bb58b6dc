"""Several vehicles in one world in the engine gazebo11 against real Gazebo 11.

Each case holds a folder for each vehicle; see test_obstacle_recordings.py for the summary and for
how far a flight may be from the recording.
"""

from __future__ import annotations

import numpy as np
import pytest
from test_gazebo_recordings import name_of
from test_obstacle_recordings import CALM, CASES, read_summaries
from test_random_recordings import parameters

import quadcore as qc

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")


FLEETS = list(read_summaries(with_fleets=True))


def place(simulation, folder):
    given = parameters(folder)
    if "twist" in given:
        twist = np.array(given["twist"], dtype=float)
        state = simulation.state.copy()
        state.linear_velocity, state.angular_velocity = twist[:3], twist[3:]
        simulation.set_state(state)


def make_vehicle(folder, world):
    return qc.Simulation(folder / "model.urdf", world=world, spawn=parameters(folder)["spawn"])


def fly_together(case):
    names = parameters(case)["vehicles"]
    fleet = qc.Fleet({name: make_vehicle(case / name, case / "case.world") for name in names})
    for name, vehicle in fleet.vehicles.items():
        place(vehicle, case / name)
    commands = {name: case / name / "commands.csv" for name in names}
    return fleet.run(float(parameters(case)["duration"][0]), commands)


def fly_alone(case, name):
    vehicle = make_vehicle(case / name, case / "case.world")
    place(vehicle, case / name)
    duration = float(parameters(case)["duration"][0])
    return vehicle.run(duration, commands=case / name / "commands.csv")


@pytest.mark.parametrize("case, row", FLEETS, ids=[name_of(case) for case, _ in FLEETS])
def test_vehicles_collide_as_in_the_recording(case, row):
    for name, log in fly_together(case).items():
        recorded = np.loadtxt(case / name / "record.csv.gz", delimiter=",", skiprows=1)
        rows = np.rint(recorded[:, 0] / float(row["step_s"])).astype(int)
        apart = np.linalg.norm(log.position[rows] - recorded[:, 1:4], axis=1)
        assert apart[recorded[:, 0] <= float(row["calm_until_s"])].max() < CALM, name
        assert apart.max() < float(row["bar_m"]), name


APART = [case for case, row in FLEETS if row["case"] in ("V_apart_a01", "V_ground_a01")]


@pytest.mark.parametrize("case", APART, ids=name_of)
def test_vehicles_that_do_not_touch_fly_bit_for_bit_as_alone(case):
    for name, log in fly_together(case).items():
        alone = fly_alone(case, name)
        assert log.position.tobytes() == alone.position.tobytes()
        assert log.rotor_velocity.tobytes() == alone.rotor_velocity.tobytes()


def test_a_vehicle_in_a_fleet_pushes_free_bodies_as_alone():
    case = next(case for case, row in CASES if row["case"] == "D_roll_a00")
    fleet = qc.Fleet([make_vehicle(case, case / "case.world")])
    (vehicle,) = fleet.vehicles.values()
    place(vehicle, case)
    (log,) = fleet.run(1.0, case / "commands.csv").values()
    single = make_vehicle(case, case / "case.world")
    place(single, case)
    alone = single.run(1.0, commands=case / "commands.csv")
    assert log.position.tobytes() == alone.position.tobytes()
    together, (body,) = fleet.free_bodies, single.free_bodies
    assert together[0].position.tobytes() == body.position.tobytes()
