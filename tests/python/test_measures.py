"""What is measured of a flight, and over seeds, beside closed forms."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from evaluations import evaluate
from scipy import signal
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.simulation.log import Log
from quadcore.studies import tracking_metrics
from quadcore.studies.evaluate.intervals import compute_cvar
from quadcore.studies.evaluate.seed_statistics import summarise_seeds
from quadcore.studies.measured_flight import NAN, Outcome
from quadcore.studies.step_response import step_response
from quadcore.studies.table import NOT_FLOWN, count_outcomes


def log_of(time, wanted, position, rotors=None):
    """A log of a motion along x."""
    table = np.zeros((len(time), 16 if rotors is None else 14 + rotors.shape[1]))
    table[:, 0], table[:, 1], table[:, 7] = time, position, 1
    if rotors is not None:
        table[:, 14:] = rotors
    zero = np.zeros(len(time))
    topics = {
        "reference": {"x": wanted, "y": zero, "z": zero, "yaw": zero},
        "error": {"x": position - wanted, "y": zero, "z": zero},
    }
    return Log(table, {}, topics=topics)


def rotors_of(*torques, slowdown=1.0):
    return [SimpleNamespace(torque_coefficient=c, slowdown=slowdown) for c in torques]


def test_measures_are_those_of_a_motion_in_closed_form():
    time = np.linspace(0, 20, 2001)
    error = 0.3 * np.exp(-time / 4)
    rotors = np.column_stack([100 + 10 * time, np.full(2001, -50.0)])
    log = log_of(time, np.sin(time), np.sin(time) + error, rotors)
    found = tracking_metrics.measure(log, 0.25, rotors_of(2e-6, 3e-6))
    assert found["max_position"] == pytest.approx(0.3)
    assert found["rms_position"] == pytest.approx(
        np.sqrt(0.09 * 2 * (1 - np.exp(-10)) / 20), rel=2e-3
    )
    assert found["final_position"] == pytest.approx(0.3 * np.exp(-10.01 / 4))
    assert found["iae_position"] == pytest.approx(1.2 * (1 - np.exp(-5)), rel=1e-4)
    assert found["itae_position"] == pytest.approx(0.3 * 16 * (1 - 6 * np.exp(-5)), rel=1e-4)
    assert found["effort"] == pytest.approx(5)
    ramp = (300.0**4 - 100.0**4) / 40  # of (100 + 10 t)^3 over 20 s
    assert found["energy"] == pytest.approx(2e-6 * ramp + 3e-6 * 50**3 * 20, rel=1e-5)
    assert found["saturated"] == 0.25
    assert np.isnan(found["rise_time"])


def test_rise_overshoot_and_settling_are_those_of_a_second_order_system():
    w, d = 2.0, 0.4
    time = np.arange(0, 20, 1e-3)
    since = np.maximum(time - 2.0005, 0)
    root = np.sqrt(1 - d**2)
    answer = 1 - np.exp(-d * w * since) * (
        np.cos(root * w * since) + d / root * np.sin(root * w * since)
    )
    wanted = np.where(time >= 2.0005, 5.0, 3.0)
    found = tracking_metrics.measure(log_of(time, wanted, 3 + 2 * answer), 0, rotors_of(0, 0))
    assert found["overshoot"] == pytest.approx(np.exp(-np.pi * d / root), rel=1e-3)
    t = np.arange(0, 20, 1e-4)
    exact = 1 - np.exp(-d * w * t) * (np.cos(root * w * t) + d / root * np.sin(root * w * t))
    rise = t[np.argmax(exact >= 0.9)] - t[np.argmax(exact >= 0.1)]
    assert found["rise_time"] == pytest.approx(rise, abs=3e-3)
    settled = t[np.flatnonzero(np.abs(exact - 1) > 0.02)[-1]]
    assert found["settling_time"] == pytest.approx(settled, abs=3e-3)


def test_effort_and_energy_are_those_of_the_speeds_whatever_the_joints_are_slowed_to():
    time = np.linspace(0, 20, 2001)
    rotors = np.column_stack([100 + 10 * time, np.full(2001, -50.0)])
    given = time, 0 * time, 0 * time
    whole, slowed = (
        tracking_metrics.measure(
            log_of(*given, rotors / slow), 0, rotors_of(2e-6, 3e-6, slowdown=slow)
        )
        for slow in (1, 10)
    )
    for name in ("effort", "energy"):
        assert slowed[name] == pytest.approx(whole[name], rel=1e-12)


def test_tilt_speed_and_rate_are_their_maxima():
    time = np.linspace(0, 4, 401)
    log = log_of(time, 0 * time, 0 * time)
    half = 0.3 * np.sin(time) / 2  # of a tilt about an axis in the plane, after a turn about z
    turn = np.stack(
        [0 * half, 0 * half, np.full_like(half, np.sin(0.4)), np.full_like(half, np.cos(0.4))]
    )
    tilt = np.stack([np.sin(half) * 0.6, np.sin(half) * 0.8, 0 * half, np.cos(half)])
    log.orientation[:] = (Rotation.from_quat(turn.T) * Rotation.from_quat(tilt.T)).as_quat()
    log.linear_velocity[:] = np.outer(np.cos(time), [1, 2, 2])
    log.angular_velocity[:] = np.outer(time, [0, 3, 4])
    found = tracking_metrics.measure(log, 0, rotors_of(0, 0))
    assert found["max_tilt"] == pytest.approx(0.3, rel=1e-4)
    assert found["max_speed"] == pytest.approx(3)
    assert found["max_rate"] == pytest.approx(20)


def test_effort_does_not_depend_on_the_rows_of_the_log():
    options = {"parameters": {"odometry.positionNoise": 0.002}, "spawn": (0, 0, 10)}
    found = [evaluate("pd", "hover", log_every=n, **options).table[0] for n in (1, 10, 100)]
    for name in ("effort", "command_effort"):
        assert found[0][name] == found[1][name] == found[2][name]
    simulation = qc.Simulation("quadrotor", "eigen", xacro_args={"sim_slow": 1}, **options)
    log = simulation.run(1.0, controller="pd", reference="hover")
    travelled = np.abs(np.diff(np.abs(log.rotor_velocity), axis=0)).sum(axis=0)
    assert found[0]["effort"] == pytest.approx(travelled.mean(), rel=1e-9)


def test_command_effort_is_the_variation_of_the_commands():
    def chatter(t, state, reference):
        return np.array([100.0, -100.0, 100.0, -100.0]) + 5 * (-1) ** round(500 * t)

    (row,) = evaluate(chatter, "hover").table
    assert row["command_effort"] == pytest.approx(499 * 10)  # per second, at 500 Hz


def test_the_steady_error_of_a_short_flight_is_that_of_its_second_half():
    time = np.linspace(0, 4, 401)
    found = tracking_metrics.measure(
        log_of(time, 0 * time, np.where(time <= 2, 1, 0.25)), 0, rotors_of(0, 0)
    )
    assert found["steady_position"] == pytest.approx(0.25)


def test_who_is_more_than_5_m_off_is_lost():
    time = np.linspace(0, 10, 101)
    assert tracking_metrics.find_failure_time(log_of(time, 0 * time, 0.49 * time)) is None
    assert tracking_metrics.find_failure_time(log_of(time, 0 * time, 0.7 * time)) == pytest.approx(
        7.2
    )
    assert tracking_metrics.find_failure_time(log_of(time, 0 * time, np.full(101, np.nan))) == 0


def test_the_step_response_is_found_in_any_motion_that_excites_it():
    rate, lag = 100, 0.3
    time = np.arange(0, 40, 1 / rate)
    wanted = np.cumsum(np.random.default_rng(4).normal(size=len(time))) / 50
    position = np.zeros_like(wanted)
    for k in range(1, len(time)):  # a lag of first order, exactly for held inputs
        part = np.exp(-1 / rate / lag)
        position[k] = part * position[k - 1] + (1 - part) * wanted[k - 1]
    response = step_response(log_of(time, wanted - wanted[0], position - position[0]))
    expected = 1 - np.exp(-response[:, 0] / lag)
    assert np.abs(response[:, 1] - expected).max() < 0.12
    assert response[-1, 1] == pytest.approx(1, abs=0.05)
    assert step_response(log_of(time, np.cos(0.5 * time), np.cos(0.5 * time))) is None
    assert step_response(log_of(time[:300], wanted[:300], position[:300])) is None


def second_order_log(rate, wanted):
    """A log of a second-order system that follows a reference exactly, and its step response."""
    w, d = 6.0, 0.5
    time = np.arange(0, 30, 1e-3)
    position = signal.lsim(([w**2], [1, 2 * d * w, w**2]), wanted(time), time, interp=False)[1]
    every = round(1000 / rate)
    t, exact = signal.step(([w**2], [1, 2 * d * w, w**2]), T=np.arange(0, 4, 1e-4))
    return log_of(time[::every], wanted(time)[::every], position[::every]), t, exact


@pytest.mark.parametrize(
    ("wanted", "most"),
    [
        (lambda time: np.where(time >= 2, 1.0, 0.0), 0.01),
        (lambda time: np.where(time >= 2, 1.0, 0.0) - np.where(time >= 11.37, 1.0, 0.0), 0.01),
        (lambda time: np.sin(0.3 * time**1.6) + np.sin(1 - np.cos(0.9 * time)) * time / 20, 0.06),
    ],
    ids=["step", "steps", "smooth"],
)
@pytest.mark.parametrize("rate", [100, 1000])
def test_the_step_response_of_a_second_order_system_has_no_dead_time(rate, wanted, most):
    log, t, exact = second_order_log(rate, wanted)
    after, response = step_response(log).T
    shifts = np.arange(-0.02, 0.02, 5e-4)
    errors = [np.abs(np.interp(after - s, t, exact, left=0) - response).max() for s in shifts]
    assert abs(shifts[np.argmin(errors)]) < 0.005
    assert np.abs(np.interp(after, t, exact) - response).max() < most


def test_the_value_at_risk_is_the_mean_of_the_worst_tenth():
    assert compute_cvar(np.arange(1, 21)) == pytest.approx(19.5)
    assert compute_cvar(np.array([1.0, 7.0])) == 7
    assert np.isnan(compute_cvar(np.array([])))


def make_outcomes(*values):
    """Outcomes of flights: a number each, None of one that was lost, NaN of one not flown."""
    return [
        Outcome("lost", NAN)
        if value is None
        else Outcome()
        if np.isnan(value)
        else Outcome("", dict.fromkeys(NAN, value))
        for value in values
    ]


def test_flights_that_an_interrupt_left_out_did_not_fail():
    (row,) = summarise_seeds(
        [(0, 0)] * 3, [{"seed": i} for i in range(3)], make_outcomes(2.0, None, np.nan)
    )
    assert (row["flights"], row["not_flown"], row["failure_rate"]) == (2, 1, 0.5)
    (row,) = summarise_seeds([(0, 0)] * 2, [{}] * 2, make_outcomes(np.nan, np.nan))
    assert (row["flights"], row["not_flown"]) == (0, 2)
    assert np.isnan(row["failure_rate"])
    assert count_outcomes(["", "lost", NOT_FLOWN]) == ("3 flights: 1 flown, 1 failed, 1 not flown")


def test_a_lost_flight_is_worse_than_any_in_the_value_at_risk():
    flights = make_outcomes(*range(1, 20), None)
    (row,) = summarise_seeds([(0, 0)] * 20, [{}] * 20, flights)
    assert row["mean_rms_position"] == 10
    assert row["cvar_rms_position"] == np.inf


def test_every_measure_has_an_interval_and_a_paired_difference():
    first, second = make_outcomes(1.0, 2.0, 4.0), make_outcomes(1.5, 2.5, 4.5)
    _, row = summarise_seeds([(0, 0)] * 3 + [(1, 0)] * 3, [{}] * 6, first + second)
    for name in NAN:
        assert row[f"low_{name}"] < row[f"mean_{name}"] < row[f"high_{name}"]
        ends = row[f"difference_low_{name}"], row[f"difference_high_{name}"]
        assert ends == (0.5, 0.5)  # seed by seed
