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
    "pd",
    "pd_compensated:fastest=560",
    "pd:flat_rates=1,feed_forward=0,lead=1,delay=0.004",
    "pid:rate=500",
    "px4",  # only alone
)


CASCADES = ("pd", "pd_compensated", "pid", "pid_thesis")


def make_plans(model, engine, reference, laws=LAWS, **others):
    plan = FlightPlan.of(
        model,
        engine=engine,
        xacro_args={"sim_slow": 1},
        parameters=NOISE,
        duration=1.6,
        log_every=8,
        **others,
    )
    return [
        replace(
            plan,
            seed=seed,
            controller=controllers.parse(law, model),
            reference=references.parse(reference),
        )
        for seed, law in enumerate(laws)
    ]


@pytest.fixture(params=["1", "2", "4", ""])
def fly_in_lanes(monkeypatch, request):
    """Fly plans as one batch with a width of the lanes."""

    def fly(plans):
        if request.param:
            monkeypatch.setenv("QUADCORE_LANES", request.param)
        together = fly_group([partial(lambda plan: plan, plan) for plan in plans], 100)
        monkeypatch.delenv("QUADCORE_LANES", raising=False)
        assert together is not None
        return together

    return fly


def check_against_single_flights(plans, together):
    for plan, record in zip(plans, together):
        alone = plan.fly()
        for name in LOGGED:
            np.testing.assert_array_equal(getattr(record.log, name), getattr(alone, name), name)
        assert record.failure == ""


@pytest.mark.parametrize(
    "engine, reference",
    [("eigen", "eight:along=1"), ("gazebo11", "step:dx=15,dyaw=3,time=0.2")],  # infeasible demands
)
def test_every_controller_flies_as_alone(fly_in_lanes, engine, reference):
    plans = make_plans("quadrotor", engine, reference)
    check_against_single_flights(plans, fly_in_lanes(plans))


@pytest.mark.parametrize(
    "rpy", [(3.1, 0.1, 0.4), (0.3, np.pi / 2, 0.2), (0.3, 1.5e-6 - np.pi / 2, 3.0)]
)
def test_cascades_fly_as_alone_upside_down_and_at_a_pitch_of_90_degrees(fly_in_lanes, rpy):
    plans = make_plans(
        "quadrotor", "eigen", "hover:height=50,yaw=-3", 3 * CASCADES, spawn=(0, 0, 50, *rpy)
    )
    together = fly_in_lanes(plans)
    assert min(record.saturated for record in together) > 0
    check_against_single_flights(plans, together)


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
