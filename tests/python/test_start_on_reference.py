"""Runs that start on their reference: the start follows all checks of the arguments."""

from __future__ import annotations

import pickle

import pytest
from flights import quadrotor
from test_fleet import make_vehicle, quiet_fleet

import quadcore as qc

WRONG = [
    {"duration": -1},
    {"log_every": 0},
    {"topics": ["nowhere"]},
    {"controller": "nobody"},
    {"progress": 3},
]


def follow(**options):
    return {
        "duration": 0.01,
        "controller": "geometric",
        "reference": "circle:height=3",
        "on_reference": True,
        **options,
    }


@pytest.mark.parametrize("wrong", WRONG, ids=str)
def test_a_refused_run_does_not_move_the_vehicle(wrong):
    simulation = quadrotor("eigen")
    before = pickle.dumps(simulation.snapshot())
    with pytest.raises(qc.InputError):
        simulation.run(**follow(**wrong))
    assert pickle.dumps(simulation.snapshot()) == before


def test_a_run_of_a_member_of_a_fleet_does_not_move_it():
    vehicle = make_vehicle(5)
    quiet_fleet(vehicle)
    with pytest.raises(qc.InputError, match=r"Use Fleet\.run"):
        vehicle.run(**follow())
    assert vehicle.state.position.tolist() == [0, 0, 5]


@pytest.mark.parametrize(
    "wrong",
    [
        *WRONG,
        {"controller": {"a": "geometric"}, "commands": {"b": [[0, 1, 2]]}},
        {"reference": {"a": "circle", "b": "nowhere"}},
        {"reference": {"a": "circle", "b": lambda t: None}},
    ],
    ids=[*map(str, WRONG), "commands", "unknown reference", "empty reference"],
)
def test_a_refused_run_of_a_fleet_moves_no_vehicle(wrong):
    fleet = quiet_fleet(a=make_vehicle(5), b=make_vehicle(9))
    options = follow(**wrong)
    if "commands" in options:
        options["reference"] = {"a": options["reference"]}
    with pytest.raises(qc.InputError):
        fleet.run(**options)
    heights = {name: vehicle.state.position[2] for name, vehicle in fleet.vehicles.items()}
    assert heights == {"a": 5, "b": 9}


def test_a_start_on_a_reference_needs_one():
    without = {"controller": "pd", "on_reference": True}
    with pytest.raises(qc.InputError, match="needs a reference to begin on"):
        quadrotor("eigen").run(0.01, **without)
    with pytest.raises(qc.InputError, match="needs a reference to begin on"):
        quiet_fleet(a=make_vehicle(5), b=make_vehicle(9)).run(0.01, **without)
    with pytest.raises(qc.InputError, match="needs a reference to begin on"):
        qc.FlightPlan.of("quadrotor", engine="eigen", **without).fly()


def test_a_vehicle_of_a_fleet_without_a_reference_starts_where_it_is():
    fleet = quiet_fleet(a=make_vehicle(5), b=make_vehicle(9))
    logs = fleet.run(**follow(controller={"a": "geometric"}, reference={"a": "hover:height=3"}))
    assert [log.position[0, 2] for log in logs.values()] == [3, 9]
