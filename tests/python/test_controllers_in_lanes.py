"""Controllers that the lanes of a batch call together: each flight is bit-identical to the flight
alone, for every width of the lanes."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from quadcore.control import controllers, references
from quadcore.simulation.flight_plan import FlightPlan
from quadcore.studies.grouped_flights import fly_group

LOGGED = ("time", "position", "orientation", "linear_velocity", "angular_velocity")
NOISE = {"odometry.positionNoise": 0.002, "odometry.angularVelocityNoise": 0.003}
LAWS = (
    "geometric",
    "geometric:kp_xy=5,fastest=560",  # its rotors saturate
    "geometric:flat_rates=0,integral=0,gyroscopic=0",
    "geometric:drag=0,feed_forward=0,lead=0",
    "indi",
    "indi:filter=60,integral=1,delay=0.004",
    "lqr",
    "lqr:flat_rates=0,rate=250",
    "pid",  # only alone
)


def make_plans(model, engine, reference):
    plan = FlightPlan.of(
        model,
        engine=engine,
        xacro_args={"sim_slow": 1},
        parameters=NOISE,
        duration=1.6,
        log_every=8,
    )
    return [
        replace(
            plan,
            seed=seed,
            controller=controllers.parse(law, model),
            reference=references.parse(reference),
        )
        for seed, law in enumerate(LAWS)
    ]


@pytest.mark.parametrize("width", ["1", "2", "4", ""])
@pytest.mark.parametrize(
    "engine, reference",
    [("eigen", "eight:along=1"), ("gazebo11", "step:dx=15,dyaw=3,time=0.2")],  # infeasible demands
)
def test_every_controller_flies_as_alone(monkeypatch, width, engine, reference):
    plans = make_plans("quadrotor", engine, reference)
    if width:
        monkeypatch.setenv("QUADCORE_LANES", width)
    together = fly_group([partial(lambda plan: plan, plan) for plan in plans], 100)
    monkeypatch.delenv("QUADCORE_LANES", raising=False)
    assert together is not None
    for plan, record in zip(plans, together):
        alone = plan.fly()
        for name in LOGGED:
            np.testing.assert_array_equal(getattr(record.log, name), getattr(alone, name), name)
        assert record.failure == ""


def test_six_rotors_share_infeasible_demands():
    plans = [
        replace(plan, controller=controllers.parse("geometric", "hexarotor"))
        for plan in make_plans("hexarotor", "eigen", "step:dx=15,dyaw=3,time=0.2")
    ]
    together = fly_group([partial(lambda plan: plan, plan) for plan in plans], 100)
    assert together is not None
    assert max(record.saturated for record in together) > 0
    for plan, record in zip(plans, together):
        np.testing.assert_array_equal(record.log.position, plan.fly().position)
