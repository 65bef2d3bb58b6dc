"""Poles of the cascaded controllers, compared with linearised flights and closed formulas."""

from __future__ import annotations

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main
from quadcore.control import controllers
from quadcore.simulation.simulation import make_simulation
from quadcore.studies.evaluate.poles import compute_poles, format_poles, has_poles, read_gains

NO_DRAG = {f"drone_plugin.{kind}DragCoeff": 0 for kind in ("induced", "translational", "profile")}


def by_axis(controller, engine="eigen", slow=1, **parameters):
    simulation = make_simulation(engine, xacro_args={"sim_slow": slow}, parameters=parameters)
    return {row["axis"]: row for row in compute_poles(controller, simulation)}


def test_the_zero_of_the_yaw_is_where_air_and_spin_up_cancel():
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1})
    hover = np.sqrt(simulation.mass * 9.8 / 4 / 1.1487e-5)
    zero = 2 * 2.69e-7 * hover / 2.8125e-5
    for slow in (1, 10):
        assert by_axis(controllers.pid_thesis(), slow=slow)["yaw"]["zero"] == pytest.approx(
            zero * slow
        )
    assert np.isinf(by_axis(controllers.pid_thesis(), "lagrange")["yaw"]["zero"])
    opposing = by_axis(controllers.pid_thesis(), **{"drone_plugin.reactionTorque": "opposing"})
    assert opposing["yaw"]["zero"] == pytest.approx(-zero)
    assert opposing["yaw"]["stable"]


def test_info_and_failures_name_a_zero_in_the_right_half_plane(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = "The yaw dynamics have a zero at +9.01 1/s"
    slow = ["--xacro", "sim_slow:=1"]
    assert main(["info", "quadrotor", *slow]) == 0
    assert text in capsys.readouterr().out
    assert main(["info", "crazyflie"]) == 0
    assert "zero at" not in capsys.readouterr().out
    lost = [
        "--controller",
        "pd:kp_yaw=100,kd_yaw=20",
        "--reference",
        "hover",
        "--spawn",
        "0,0,9,0,0,1",
    ]
    limit = ["--duration", "10", "--failure-distance", "0.5"]
    assert main(["evaluate", *lost, *limit, *slow]) == 3
    assert f"quadrotor: t{text[1:]}" in capsys.readouterr().out


@pytest.mark.parametrize("scale", [0.8, 1])
def test_the_printed_gains_are_unstable_in_x_and_y_everywhere_and_in_yaw_at_sim_slow_1(scale):
    controller = controllers.pid_thesis(scale=scale)
    for engine, slow in (("eigen", 1), ("gazebo11", 10), ("lagrange", 1)):
        found = by_axis(controller, engine, slow)
        assert not found["x, y"]["stable"]
        assert found["z"]["stable"]
        assert found["roll, pitch"]["stable"]
        assert found["yaw"]["stable"] == ((engine, slow) != ("eigen", 1))
    assert all(row["stable"] for row in by_axis(controllers.pid()).values())
    assert format_poles(by_axis(controllers.pid_thesis())["x, y"], 1) == "0.231 +- 1.63i"


def test_motors_without_lag_leave_the_polynomial_of_routh_and_hurwitz():
    """Around an ideal inner loop x and y are s^3 + Kd s^2 + Kp s + Ki."""
    fast = {"kp_rp": 1e5, "kd_rp": 6e2, "ki_rp": 0}
    controller = controllers.pid_thesis(**fast)
    found = by_axis(controller, **{**NO_DRAG, "motorpid_plugin.kp": 0.07})["x, y"]["poles"]
    slow = [pole for pole in found if abs(pole) < 10]
    expected = np.roots([1, 0.125, 2.4, 0.8])
    for pole in expected:
        assert min(abs(pole - other) for other in slow) < 1e-2


def to_numbers(state):
    """A state near hover as 12 + n numbers."""
    turn = 2 * state.orientation[:3] * np.sign(state.orientation[3])
    parts = state.position, turn, state.linear_velocity, state.angular_velocity
    return np.concatenate([*parts, state.rotor_velocity])


def from_numbers(start, changes):
    state = start.copy()
    turn = changes[3:6] / 2
    state.position += changes[:3]
    state.orientation[:] = *turn, np.sqrt(1 - turn @ turn)
    state.linear_velocity += changes[6:9]
    state.angular_velocity += changes[9:12]
    state.rotor_velocity += changes[12:]
    return state


def linearise_flight(controller, slow, span=0.02):
    """Poles of plant and controller, from flights of a short span that begin beside a hover."""
    simulation = qc.Simulation(engine="eigen", dt=1e-4, xacro_args={"sim_slow": slow})
    hover = qc.references.hover()
    start = qc.references.start(simulation, hover)
    steps = np.repeat([1e-5, 1e-5, 1e-5, 1e-5, 1e-3], [3, 3, 3, 3, 4])
    columns = []
    for step in np.diag(steps):
        ends = []
        for sign in (1, -1):
            simulation.reset(0)
            simulation.set_state(from_numbers(start, sign * step))
            simulation.run(span, controller=controller, reference=hover, log_every=100)
            ends.append(to_numbers(simulation.state))
        columns.append((ends[0] - ends[1]) / (2 * step.sum()))
    return np.log(np.linalg.eigvals(np.column_stack(columns)).astype(complex)) / span


@pytest.mark.parametrize("slow", [1, 10])
@pytest.mark.parametrize("name", ["pd", "pd_compensated"])
def test_poles_are_those_of_the_linearised_flight_with_drag(name, slow):
    controller = getattr(controllers, name)(rate=10_000)
    flown = linearise_flight(controller, slow)
    found = by_axis(controller, slow=slow)
    expected = [pole for axis in ("x, y", "z", "yaw") for pole in found[axis]["poles"]]
    assert len(expected) == 11
    for pole in expected:
        assert np.abs(flown - pole).min() < 0.02 * abs(pole), pole


def test_without_drag_poles_are_those_of_the_closed_form():
    gains = read_gains(controllers.pid())
    lag = 2.8125e-5 / 0.0005  # I_R/k_p
    roll = [lag, 1, gains["kd_rp"], gains["kp_rp"], gains["ki_rp"]]
    found = by_axis(controllers.pid(), **NO_DRAG)
    assert np.sort_complex(found["roll, pitch"]["poles"]) == pytest.approx(
        np.sort_complex(np.roots(roll)), rel=1e-6
    )


def test_the_linear_delay_margin_is_where_the_loop_with_delay_has_a_pole_on_the_axis():
    controller = controllers.pd(rate=1e6)
    row = by_axis(controller)["z"]
    gains = read_gains(controller)
    lag, delay = 2.8125e-5 / 0.0005, row["delay_margin"]

    def loop(s):
        return (gains["kd_z"] * s + gains["kp_z"]) * np.exp(-s * delay) / (s**2 * (lag * s + 1))

    frequencies = 1j * np.linspace(1, 30, 100_000)
    assert np.abs(1 + loop(frequencies)).min() < 1e-3


def test_the_yaw_grows_in_flight_as_its_pole_says():
    controller = controllers.pid_thesis(rate=1000)
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1})
    hover = qc.references.hover()
    simulation.set_state(qc.references.start(simulation, hover))
    state = simulation.state.copy()
    state.angular_velocity[:] = 0, 0, 1e-6
    simulation.set_state(state)
    log = simulation.run(0.9, controller=controller, reference=hover)
    yaw = 2 * log.orientation[:, 2]
    growing = by_axis(controller)["yaw"]["poles"][0]
    late = log.time > 0.4
    # e^(a t) (c cos b t + d sin b t) fits what the slower poles leave by then.
    a, b, t = growing.real, abs(growing.imag), log.time[late]
    shape = np.exp(a * t)[:, None] * np.column_stack([np.cos(b * t), np.sin(b * t)])
    found, *_ = np.linalg.lstsq(shape, yaw[late], rcond=None)
    assert np.abs(shape @ found - yaw[late]).max() < 0.05 * np.abs(yaw[late]).max()


def test_only_cascades_have_poles():
    assert has_poles(controllers.pd())
    assert not has_poles(controllers.geometric())
    assert not has_poles(lambda t, state, reference: None)
    assert read_gains(controllers.pid_thesis(kp_z=3))["kp_z"] == 3
    assert read_gains(controllers.pid_thesis())["kd_xy"] == 0.125


def test_the_page_names_both_causes_of_the_printed_gains():
    found = by_axis(controllers.pid_thesis())
    assert "Kd Kp = 0.3 is not above Ki = 0.8" in found["x, y"]["because"]
    assert "2 b w0 sim_slow / I_R = +9.01 1/s" in found["yaw"]["because"]
    assert not found["z"]["because"]
    assert not by_axis(controllers.pid_thesis(), slow=10)["yaw"]["because"]
    assert not by_axis(controllers.pid_thesis(kd_xy=2.5))["x, y"]["because"]


@pytest.mark.parametrize(("slow", "fails"), [(1, True), (10, False)])
def test_kd_2_5_alone_fails_at_sim_slow_1_by_its_yaw(slow, fails):
    controller = controllers.pid_thesis(kd_xy=2.5, rate=1000)
    assert by_axis(controller, slow=slow)["x, y"]["stable"]
    assert by_axis(controller, slow=slow)["yaw"]["stable"] != fails
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": slow})
    spiral = qc.references.spiral()
    log = simulation.run(
        15, controller=controller, reference=spiral, on_reference=True, log_every=10
    )
    away = np.linalg.norm([log.topics["error"][axis] for axis in "xyz"], axis=0)
    turn = np.abs(log.angular_velocity[:, 2])[log.time > 5]
    assert (away.max() > 0.5) == fails
    assert (turn.max() > 0.5) == fails
