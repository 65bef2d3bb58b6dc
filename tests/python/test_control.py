"""Controllers and references from Python."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from flights import ENGINES, NOISE, quadrotor
from twin_controller import Twin

import quadcore as qc
from quadcore.control import controllers, references

ROOT = Path(__file__).resolve().parents[2]
FLYING = [n for n in controllers.NAMES if n not in ("pid_thesis", *controllers.FIRMWARE)]


def at_slow(slow, **others):
    return {"drone_plugin.sim_slow": slow, "motorpid_plugin.sim_slow": slow, **others}


def on(reference, engine="eigen", slow=1, **options):
    """A simulation whose vehicle already follows a reference."""
    parameters = at_slow(slow, **options.pop("parameters", {}))
    simulation = quadrotor(engine, parameters=parameters, **options)
    simulation.set_state(references.start(simulation, reference))
    return simulation


def errors(log, reference):
    wanted = np.array([reference(t).position for t in log.time])
    return np.linalg.norm(log.position - wanted, axis=1)


def max_at_the_end(log, reference, seconds=10):
    return errors(log, reference)[log.time > log.time[-1] - seconds].max()


@pytest.mark.parametrize(
    ("engine", "slow", "bar"),
    [("eigen", 1, 0.05e-3), ("ode", 1, 0.4e-3), ("gazebo11", 1, 0.8e-3), ("gazebo11", 10, 0.4e-3)],
)
def test_the_geometric_controller_flies_the_spiral_of_the_thesis(engine, slow, bar):
    spiral = references.spiral()
    log = on(spiral, engine, slow).run(30, controller="geometric", reference=spiral, log_every=5)
    assert max_at_the_end(log, spiral) < bar


@pytest.mark.parametrize(
    ("reference", "bar"),
    [
        (references.circle(), 1e-3),
        (references.eight(), 5e-3),
        (references.waypoints(ROOT / "config" / "waypoints.yaml"), 4e-3),
    ],
    ids=lambda value: value.name if isinstance(value, references.Shape) else "",
)
def test_the_geometric_controller_flies_fast_references(reference, bar):
    log = on(reference).run(12, controller="geometric", reference=reference)
    assert errors(log, reference).max() < bar


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("slow", [1, 10])
def test_the_printed_gains_lose_the_spiral(engine, slow):
    spiral = references.spiral()
    simulation = on(spiral, engine, slow)
    try:
        log = simulation.run(
            30, controller=controllers.pid_thesis(rate=1000), reference=spiral, log_every=10
        )
    except qc.FlightError as error:
        log = error.log
    assert errors(log, spiral).max() > 5


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("controller", FLYING)
def test_every_controller_settles_at_a_position_through_noise(engine, controller):
    hover = references.hover(x=0.3, y=-0.2, height=10.02, yaw=0.2)
    simulation = quadrotor(engine, parameters=at_slow(1, **NOISE), seed=3)
    log = simulation.run(30, controller=controller, reference=hover, log_every=10)
    assert max_at_the_end(log, hover, 2) < 0.01


def test_the_controller_and_its_twin_in_numpy_fly_one_flight():
    spiral = references.spiral()
    logs = [
        on(spiral).run(1, controller=controller, reference=spiral)
        for controller in ("geometric", Twin())
    ]
    assert np.abs(logs[0].position - logs[1].position).max() < 1e-9


@pytest.mark.parametrize("believed", [0.9, 1.1])
def test_a_thrust_believed_wrong_is_made_up_for(believed):
    spiral = references.spiral()
    controller = controllers.geometric(believed_thrust=believed)
    log = on(spiral).run(30, controller=controller, reference=spiral, log_every=10)
    assert max_at_the_end(log, spiral) < 0.02


@pytest.mark.parametrize("engine", ENGINES)
def test_the_geometric_controller_recovers_from_upside_down(engine):
    hover = references.hover(height=50)
    simulation = quadrotor(engine, parameters=at_slow(1), spawn=(0, 0, 50, np.pi, 0, 0))
    controller = controllers.geometric(fastest=900)
    log = simulation.run(6, controller=controller, reference=hover)
    assert errors(log, hover)[log.time > 3].max() < 0.1
    assert log.position[:, 2].min() > 48


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("controller", ["geometric", "indi", "lqr"])
def test_wind_is_made_up_for(controller, engine, tmp_path):
    windy = tmp_path / "windy.world"
    windy.write_text(
        "<sdf><world><wind><linear_velocity>2.2 -2 0.3</linear_velocity></wind></world></sdf>"
    )
    hover = references.hover()
    parameters = at_slow(1, **{"drone_plugin.dragModel": "chapter2"})
    simulation = quadrotor(engine, parameters=parameters, world=windy)
    log = simulation.run(22, controller=controller, reference=hover, log_every=10)
    assert errors(log, hover).max() > 0.01
    assert max_at_the_end(log, hover, 2) < 1e-3


@pytest.mark.parametrize(
    ("engine", "slow"), [("ode", 1), ("gazebo11", 1), ("gazebo11", 10), ("eigen", 1), ("eigen", 10)]
)
def test_the_geometric_controller_takes_off_hovers_and_lands(engine, slow):
    flight = references.takeoff_land(stay=8)
    simulation = quadrotor(engine, parameters=at_slow(slow), world="default", spawn=(0, 0, 0.0125))
    log = simulation.run(flight.end + 2, controller="geometric", reference=flight, log_every=10)
    off = errors(log, flight)
    assert off[(log.time > 10) & (log.time < 13)].max() < 1e-3
    assert off[log.time > flight.end + 1].max() < 5e-3


@pytest.mark.parametrize(
    ("reference", "options", "bar"),
    [
        (references.circle(), {}, 20e-3),
        (references.circle(), {"rate_damping": 0.81}, 4e-3),
        (references.eight(), {}, 35e-3),
        (references.waypoints(ROOT / "config" / "waypoints.yaml"), {}, 12e-3),
    ],
    ids=lambda value: value.name if isinstance(value, references.Shape) else "",
)
def test_the_geometric_controller_flies_fast_references_in_gazebo(reference, options, bar):
    controller = controllers.geometric(**options)
    log = on(reference, "gazebo11").run(12, controller=controller, reference=reference, log_every=5)
    assert errors(log, reference).max() < bar


@pytest.mark.parametrize(
    ("engine", "bar"), [("eigen", 0.5e-3), ("ode", 0.5e-3), ("gazebo11", 2e-3)]
)
def test_the_compensated_cascade_flies_the_spiral(engine, bar):
    spiral = references.spiral()
    log = on(spiral, engine).run(12, controller="pd_compensated", reference=spiral, log_every=5)
    assert max_at_the_end(log, spiral, 6) < bar


def test_a_delay_equals_that_of_a_controller_that_waits_by_itself():
    hover = references.hover(x=0.1)

    class Late:
        rate = 500

        def reset(self, simulation):
            self.inner = controllers.geometric()
            self.inner.reset(simulation)
            self.waiting = []

        def __call__(self, t, state, reference):
            self.waiting.append(self.inner(t, state, reference))
            return self.waiting.pop(0) if len(self.waiting) > 3 else self.waiting[0]

    one = quadrotor("eigen").run(1, controller=controllers.geometric(delay=0.006), reference=hover)
    other = quadrotor("eigen").run(1, controller=Late(), reference=hover)
    assert np.array_equal(one.table, other.table)


def test_the_start_is_that_of_a_vehicle_on_the_way():
    circle = references.circle()
    simulation = on(circle)
    log = simulation.run(0.2, controller="geometric", reference=circle)
    assert errors(log, circle).max() < 0.1e-3


def test_a_run_may_begin_on_its_reference():
    circle = references.circle()
    simulation = quadrotor("eigen")
    simulation.set_state(references.start(simulation, circle))
    by_hand = simulation.run(0.5, controller="pd", reference=circle)
    by_option = quadrotor("eigen").run(0.5, controller="pd", reference="circle", on_reference=True)
    assert by_option.table.tobytes() == by_hand.table.tobytes()
    with pytest.raises(qc.InputError, match="needs a reference to begin on"):
        quadrotor("eigen").run(0.5, controller="pd", on_reference=True)


def test_references_and_controllers_can_be_pickled():
    for reference in (
        references.eight(width=2),
        references.waypoints([[0, 0, 0, 1], [2, 1, 0, 1]]),
    ):
        copy = pickle.loads(pickle.dumps(reference))
        assert np.array_equal(copy(0.7).position, reference(0.7).position)
        assert repr(copy) == repr(reference)
    assert pickle.loads(pickle.dumps(controllers.pd(kp_xy=1))).parameters == {"kp_xy": 1}


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"reference": "spiral"}, "a reference needs a controller"),
        ({"controller": "geometric"}, "has no reference to follow"),
        ({"controller": "geometrik", "reference": "spiral"}, "Did you mean 'geometric'"),
        ({"controller": "pd", "reference": "spirale"}, "Did you mean 'spiral'"),
        ({"controller": "pd", "reference": 5}, "reference is 5. Give one of quadcore.references"),
        (
            {"controller": controllers.pd(delay=-1), "reference": "hover"},
            "its delay is -1. Give seconds",
        ),
        ({"controller": controllers.pd(kp=1), "reference": "hover"}, "has no parameter 'kp'"),
        ({"controller": controllers.pd(kp_xy=-1), "reference": "hover"}, "'kp_xy' is -1. Give"),
        ({"controller": controllers.pd(spins=[1, 1, 1, 1]), "reference": "hover"}, "independently"),
        (
            {"controller": controllers.pd(spins=[1, -1]), "reference": "hover"},
            "spins are not 4 signs",
        ),
    ],
)
def test_what_cannot_be_flown_is_refused_before_the_flight(arguments, says):
    simulation = quadrotor("eigen")
    with pytest.raises(qc.InputError, match=says):
        simulation.run(1, **arguments)
    assert simulation.time == 0


def test_parameters_are_documented_where_they_are_given():
    assert "kp_xy : float, default 2.4" in controllers.pd.__doc__
    assert "kd_xy : float, default 0.125" in controllers.pid_thesis.__doc__
    assert "rate : float, default 1.5" in references.circle.__doc__
    with pytest.raises(AttributeError, match="controller 'pdd' does not exist"):
        controllers.pdd  # noqa: B018


def reference_without(member, index):
    """A hover of which one number is missing from 0.2 s on."""

    def wanted(t):
        point = qc.Reference(position=[0, 0, 10])
        if t > 0.2:
            values = np.array(getattr(point, member))
            values[index] = np.nan
            setattr(point, member, values)
        return point

    return wanted


@pytest.mark.parametrize(
    "controller, member, index",
    [
        *((name, "position", 2) for name in controllers.NAMES),
        ("geometric", "velocity", 0),
        ("indi", "snap", 1),
        ("lqr", "yaw", ()),
    ],
)
def test_a_reference_that_is_not_finite_ends_the_flight_and_is_named(controller, member, index):
    sim = qc.Simulation("quadrotor", "eigen", xacro_args={"sim_slow": 1})
    with pytest.raises(qc.QuadcoreError, match=rf"reference\.{member} is not finite") as failed:
        sim.run(1.0, controller=controller, reference=reference_without(member, index))
    assert sim.time == pytest.approx(0.2, abs=0.02)  # the next call
    assert len(failed.value.log) > 100


@pytest.mark.parametrize("controller", controllers.NAMES)
def test_a_state_that_is_not_finite_is_no_state_for_a_controller(controller):
    sim = qc.Simulation("quadrotor", "eigen", xacro_args={"sim_slow": 1})
    law = qc.controllers.parse(controller, "quadrotor")
    law.reset(sim)
    state = sim.state.copy()
    state.linear_velocity[1] = np.inf
    with pytest.raises(qc.InputError, match=r"state\.linear_velocity is not finite"):
        law.core.command(0.01, state, qc.Reference())


@pytest.mark.parametrize("controller", ["pd", "pd_compensated", "pid"])
@pytest.mark.parametrize("orientation", [(0.5, 0.5, -0.5, 0.5), (0.5, -0.5, 0.5, 0.5)])
def test_a_cascade_commands_a_vehicle_whose_pitch_is_exactly_90_degrees(controller, orientation):
    sim = qc.Simulation("quadrotor", "eigen", xacro_args={"sim_slow": 1})
    state = sim.state.copy()
    state.orientation = np.array(orientation)
    sim.set_state(state)
    log = sim.run(0.05, controller=controller, reference="hover:height=20")
    assert np.isfinite(log.table).all()


@pytest.mark.parametrize("controller", ["pd", "pid"])
def test_a_cascade_levels_the_vehicle_where_no_force_is_demanded(controller):
    """As it does where almost none is demanded: the gain is 1/s^2, and z is g too high."""
    commands = []
    for height in (0.0, 1e-9):
        sim = qc.Simulation("quadrotor", "eigen", xacro_args={"sim_slow": 1})
        law = qc.controllers.parse(f"{controller}:kp_z=1,ki_z=0", "quadrotor")
        law.reset(sim)
        state = sim.state.copy()
        state.position = np.array([0, 0, 9.8])
        state.orientation = np.array([np.sin(0.3), 0, 0, np.cos(0.3)])
        commands.append(law.core.command(0.01, state, qc.Reference(position=[0, 0, height])))
    np.testing.assert_allclose(commands[0], commands[1], atol=1.0)
    assert np.abs(commands[0]).max() > 100
