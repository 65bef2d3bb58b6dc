"""Flights in closed loop: times and arguments of the calls, and errors of controllers."""

from __future__ import annotations

import inspect

import numpy as np
import pytest
from flights import BUSY, ENGINES, HOVER, MANOEUVRE, bits, hold_height, quadrotor

import quadcore as qc
from quadcore import _core


class HeightController:
    """Hold a height by the odometry, and record the times of the calls."""

    def __init__(self, rate=None):
        self.asked = []
        self.begun = 0
        if rate is not None:
            self.rate = rate

    def reset(self, simulation):
        self.begun += 1
        self.rotors = simulation.rotor_count

    def __call__(self, t, state, reference):
        assert reference is None
        self.asked.append(t)
        climb = 0.05 * (10 - state.position[2]) - 0.02 * state.linear_velocity[2]
        return HOVER[: self.rotors] * (1 + climb)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_controller_gives_the_bytes_of_a_loop_by_hand(engine):
    by_hand, by_controller = (quadrotor(engine, parameters=BUSY) for _ in range(2))
    hold_height(by_hand, 300)
    by_controller.run(0.3, controller=HeightController(rate=1000))
    assert bits(by_controller) == bits(by_hand)


def test_a_controller_reads_any_topic():
    heard = []

    def controller(t, state, reference):
        heard.append((state.time, state.topic("odom")["stamp"], state.topic("vel_cmd")["count"]))
        return HOVER

    simulation = quadrotor()
    simulation.run(0.01, controller=controller)
    assert [row[2] for row in heard] == list(range(len(heard))) and len(heard) == 5
    assert all(time == stamp for time, stamp, _ in heard)
    with pytest.raises(qc.InputError, match="topic 'odm' does not exist"):
        simulation.run(0.01, controller=lambda t, state, reference: state.topic("odm"))


@pytest.mark.parametrize(
    ("rate", "dt", "steps"),
    [
        (None, 0.001, range(0, 100, 2)),
        (500, 0.001, range(0, 100, 2)),
        (1000, 0.001, range(100)),
        (1e6, 0.001, range(100)),  # at most once a step
        (300, 0.001, [0, *(-(-10 * k // 3) for k in range(1, 30))]),
        (7, 0.001, [0]),
        (250, 0.003, [0, *(-(-4 * k // 3) for k in range(1, 25))]),
    ],
)
def test_a_controller_is_called_at_the_first_step_at_or_after_each_period(rate, dt, steps):
    controller = HeightController(rate)
    simulation = quadrotor("eigen", dt=dt)
    simulation.run(0.1, controller=controller)
    expected = [step for step in steps if step < round(simulation.time / dt)]
    assert np.round(np.array(controller.asked) / dt).astype(int).tolist() == expected
    assert controller.begun == 1


def test_logging_and_interruptions_do_not_change_when_a_controller_is_called():
    controllers = [HeightController(300) for _ in range(2)]
    fine = quadrotor("eigen").run(1, controller=controllers[0])
    coarse = quadrotor("eigen").run(
        1, log_every=7, controller=controllers[1], progress=lambda *_: None
    )
    assert controllers[0].asked == controllers[1].asked
    assert np.array_equal(fine.table[::7], coarse.table)


def test_a_run_goes_on_from_where_the_last_one_ended():
    controller = HeightController(rate=100)
    simulation = quadrotor("eigen")
    simulation.run(0.015, controller=controller)
    simulation.run(0.015, controller=controller)
    assert np.allclose(controller.asked, [0, 0.01, 0.015, 0.025], rtol=0, atol=1e-12)
    assert controller.begun == 2


def test_a_controller_is_given_the_measured_odometry():
    said = []

    def controller(t, state, reference):
        message = simulation.topic("odom")
        assert state.time == message["stamp"]
        assert state.position.tolist() == [message[name] for name in ("x", "y", "z")]
        assert state.orientation.tolist() == [message[f"q{name}"] for name in "xyzw"]
        assert state.linear_velocity.tolist() == [message[f"v{name}"] for name in "xyz"]
        assert state.angular_velocity.tolist() == [message[f"w{name}"] for name in "xyz"]
        said.append(state)
        return HOVER + np.array([3, -2, 1, 2])

    simulation = quadrotor("eigen", parameters=BUSY)
    log = simulation.run(0.1, controller=controller)
    assert len(said) == 50
    assert np.abs(said[-1].position - log.position[-3]).max() > 1e-3  # noise


@pytest.mark.parametrize("name", ["position", "orientation", "linear_velocity", "angular_velocity"])
def test_the_measured_odometry_cannot_be_changed(name):
    """Built-in controllers and inner loops read the message, not these arrays."""
    measured = getattr(_core.Odometry(quadrotor("eigen")), name)
    with pytest.raises(ValueError, match="read-only"):
        measured[0] += 1
    measured.copy()[0] += 1


def test_constant_speeds_by_controller_and_by_table_are_one_flight():
    by_controller = quadrotor().run(0.2, controller=lambda t, state, reference: HOVER)
    assert np.array_equal(by_controller.table, quadrotor().run(0.2, [[0, *HOVER]]).table)


def fail_after(t0, speeds):
    return lambda t, state, reference: HOVER if t < t0 else speeds


@pytest.mark.parametrize(
    ("speeds", "description"),
    [
        ([471] * 3, "[471, 471, 471]: the command has 3 rotor speeds"),
        (
            [471, np.nan, 471, 471],
            "[471, nan, 471, 471]: the command for rotor 2 is not a finite number",
        ),
        (None, "None: command is not a 1-dimensional array of numbers"),
        ("fast", "'fast': command is not a 1-dimensional array of numbers"),
    ],
)
@pytest.mark.parametrize("t0", [0, 0.1])
def test_what_is_no_command_ends_the_flight_and_its_log_stays(speeds, description, t0):
    simulation = quadrotor("eigen")
    with pytest.raises(qc.FlightError) as failed:
        simulation.run(1, controller=fail_after(t0, speeds))
    assert str(failed.value) == (
        f"the flight failed at t = {t0:f} s: the controller returned {description}. "
        "Return 4 rotor speeds in rad/s."
    )
    assert failed.value.time == simulation.time == pytest.approx(t0)
    assert len(failed.value.log) == 1 + round(1000 * t0)


def test_an_exception_of_a_controller_carries_the_log_so_far():
    def controller(t, state, reference):
        if t > 0.0495:
            raise ZeroDivisionError("of the controller")
        return HOVER

    simulation = quadrotor("eigen")
    with pytest.raises(ZeroDivisionError, match="of the controller") as raised:
        simulation.run(1, controller=controller)
    assert len(raised.value.log) == 51
    assert np.array_equal(raised.value.log.table, quadrotor("eigen").run(0.05, [[0, *HOVER]]).table)


class WithoutRate:
    rate = "often"

    def __call__(self, t, state, reference):
        return HOVER


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"controller": 5}, "controller is 5. Give a function or an object that is called as"),
        ({"controller": WithoutRate()}, "its rate is 'often'. Give calls per second, >= 1e-06"),
        ({"controller": HeightController(0)}, "its rate is 0. Give"),
        ({"controller": HeightController(np.inf)}, "its rate is inf. Give"),
        (
            {"controller": HeightController(), "commands": MANOEUVRE},
            "commands or a controller. Give one",
        ),
    ],
)
def test_what_is_no_controller_is_refused_before_the_flight(arguments, says):
    simulation = quadrotor("eigen")
    with pytest.raises(qc.InputError, match=says):
        simulation.run(1, **arguments)
    assert simulation.time == 0


def test_a_model_without_odometry_has_nothing_to_tell(toy):
    text = (toy / "toy.urdf").read_text()
    start = text.index('    <plugin name="odometry"')
    (toy / "blind.urdf").write_text(text[:start] + text[text.index("  </gazebo>", start) :])
    with pytest.raises(qc.InputError, match=r"odom.*libodometry_plugin\.so"):
        qc.Simulation("blind.urdf").run(1, controller=lambda *_: [0])


def test_the_controller_that_is_documented_can_be_called_as_it_says():
    parameters = list(inspect.signature(qc.Controller.__call__).parameters)
    assert parameters[1:] == ["t", "state", "reference"]
