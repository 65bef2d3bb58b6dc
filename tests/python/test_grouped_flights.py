"""Flights that studies run together: each is bit-identical to the flight alone."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import quadcore as qc
from quadcore.control import controllers, references
from quadcore.simulation.flight_plan import FlightPlan
from quadcore.studies.grouped_flights import fly_group
from quadcore.studies.measured_flight import fly_and_measure, fly_together

LOGGED = (
    "time",
    "position",
    "orientation",
    "linear_velocity",
    "angular_velocity",
    "rotor_velocity",
)
NOISE = {
    "odometry.positionNoise": 0.002,
    "odometry.orientationNoise": 0.001,
    "odometry.linearVelocityNoise": 0.01,
    "odometry.angularVelocityNoise": 0.003,
    "odometry.positionResolution": 0.0005,
}
SEEDS = 11  # a block and a part of a second


def make_plan(controller="geometric", reference="spiral", **options):
    options.setdefault("engine", "eigen")
    options.setdefault("on_reference", True)
    return FlightPlan.of(
        options.pop("model", "quadrotor"),
        xacro_args=options.pop("xacro_args", {"sim_slow": 1}),
        parameters={**NOISE, **options.pop("parameters", {})},
        duration=options.pop("duration", 1.5),
        log_every=10,
        controller=controllers.parse(controller, "quadrotor"),
        reference=references.parse(reference),
        **options,
    )


def of_seeds(plan, n=SEEDS):
    return [replace(plan, seed=seed, controller=plan.controller.copy()) for seed in range(n)]


def describe(plans):
    return [partial(lambda plan: plan, plan) for plan in plans]


def assert_alike(plans):
    together = fly_group(describe(plans), 100)
    assert together is not None
    for plan, record in zip(plans, together):
        alone = plan.fly()
        for name in LOGGED:
            np.testing.assert_array_equal(getattr(record.log, name), getattr(alone, name), name)
    outcomes = fly_together(describe(plans), 100)
    for described, outcome in zip(describe(plans), outcomes):
        alone = fly_and_measure(described, 100)
        assert outcome.failure == alone.failure
        np.testing.assert_equal(outcome.measures, alone.measures)
        assert outcome.updates == alone.updates


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
@pytest.mark.parametrize(
    "controller",
    ["geometric", "pid:rate=333,delay=0.0035", "lqr:rate=50", "indi", "pd_compensated"],
)
def test_seeds_fly_as_alone(engine, controller):
    assert_alike(of_seeds(make_plan(controller, engine=engine)))


def test_references_gains_and_parameters_may_differ():
    plans = [
        replace(
            make_plan(
                f"geometric:kp_xy={4 + i}" if i % 3 else "pd",
                ("spiral", "eight:along=1", "circle")[i % 3],
                parameters={"drone_plugin.rotorThrustCoeff": 8.5e-6 * (1 + 0.01 * i)}
                if i % 2
                else {},
            ),
            seed=i,
        )
        for i in range(9)
    ]
    first = plans[0]
    assert_alike([replace(plan, world=first.world, model=first.model) for plan in plans])


def test_flights_that_do_not_start_on_the_reference():
    assert_alike(of_seeds(make_plan("geometric", "step", on_reference=False)))


@pytest.mark.parametrize(
    "tags",
    [
        {"odometry.positionWalk": 0.001},
        {"odometry.delay": 0.004},
        {"odometry.dropout": 0.2},
        {"odometry.rate": 250},
    ],
    ids=str,
)
def test_sensors_that_batches_do_not_model(tags):
    assert_alike(of_seeds(make_plan(parameters=tags), 3))


def test_vehicles_with_other_plugins():
    assert_alike(of_seeds(make_plan().with_wind((1.0, 0.5, 0.0)), 3))


def test_a_lost_rotor_reaches_the_controller():
    plan = make_plan(duration=2.0).with_scenario("lost_rotor")
    assert_alike(of_seeds(plan, 2))


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_flights_between_obstacles(engine):
    """Vehicles stop where their known free space ends, while others in their block move on."""
    first = make_plan(engine=engine, world="slalom", reference="eight")
    other = replace(first, reference=references.parse("hover"))
    assert_alike([replace(first if i % 3 else other, seed=i) for i in range(5)])


def test_flights_that_fail():
    """A vehicle beyond the limits of a batch ends like alone, and the others fly on."""
    plans = of_seeds(make_plan(duration=4.0))
    plans[3] = replace(plans[3], controller=controllers.parse("geometric:delay=0.3", ""))
    together = fly_together(describe(plans), 100)
    alone = [fly_and_measure(described, 100) for described in describe(plans)]
    assert [flight.failure for flight in together] == [flight.failure for flight in alone]
    assert [bool(flight.failure) for flight in together] == [i == 3 for i in range(SEEDS)]


def test_an_evaluation_does_not_depend_on_groups(monkeypatch):
    options = {
        "seeds": 30,
        "duration": 1.0,
        "processes": 1,
        "parameters": NOISE,
        "xacro_args": {"sim_slow": 1},
    }
    together = qc.evaluate(["geometric", "pd"], ["spiral", "step"], **options)
    monkeypatch.setattr(
        "quadcore.studies.evaluate.evaluate.share_out", lambda rows, _: [[i] for i in rows]
    )
    alone = qc.evaluate(["geometric", "pd"], ["spiral", "step"], **options)
    np.testing.assert_equal(together.table, alone.table)


def test_controllers_take_over_at_the_start_only():
    plan = make_plan()
    pilot = plan.pilot(plan.simulation())
    pilot.reset(plan.simulation())
    batch = qc.BatchSimulation("quadrotor", 1, threads=1)
    batch.step(None, 1)
    with pytest.raises(qc.InputError, match=r"vehicle 0 is not at its start.*Call reset first"):
        batch._follow(
            [pilot.built_in[0]],
            [pilot.built_in[1]],
            np.array([500.0]),
            np.array([0.0]),
            "odom",
            10,
            1,
            [],
        )
