"""libimu_plugin.so: rates and specific forces, and their errors."""

from __future__ import annotations

import math

import allantools
import numpy as np
import pytest
from flights import ENGINES
from scipy.spatial.transform import Rotation
from sensed import AT, RPY, make_mounted, rows_of
from vehicles import start


def spinning(hangar, tags, engine="eigen", gravity=(0.3, -0.2, -9.7)):
    """A body that falls and turns about one of its axes, a unit mounted askew on it."""
    simulation = hangar(
        make_mounted("imu", {"link": "mast", **tags}),
        gravity,
        spawn=(1, 2, 3, 0.3, 0.2, 0.1),
        engine=engine,
    )
    w_F = 4.0 * np.linalg.eigh(simulation.inertia)[1][:, 2]
    R_WF = Rotation.from_quat(simulation.state.orientation.copy())
    c = simulation.center_of_mass
    velocity = np.array([1, -2, 0.5]) - R_WF.apply(np.cross(w_F, c))
    start(simulation, angular_velocity=w_F, linear_velocity=velocity)
    R_FS, r_F = Rotation.from_euler("xyz", RPY), np.array(AT) - c

    # Centripetal, the same at all times in the turning axes; gravity is not felt.
    f_F = np.cross(w_F, np.cross(w_F, r_F))
    return simulation, np.concatenate([R_FS.inv().apply(w_F), R_FS.inv().apply(f_F)])


@pytest.mark.parametrize("rate", [1000, 200])
def test_a_unit_on_a_tilted_link_feels_its_turn_and_its_specific_force(rate, hangar):
    simulation, felt = spinning(hangar, {"rate": rate})
    assert simulation.topic("imu")["count"] == 0  # no time has passed
    rows = rows_of(simulation, "imu", 500)
    assert len(rows) == rate // 2
    for row in rows:
        expected = felt
        for part in (slice(0, 3), slice(3, 6)):
            error = np.linalg.norm(row[1:7][part] - expected[part])
            assert error < 1e-9 * np.linalg.norm(expected[part])
    assert not rows[:, 7:].any()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_unit_at_rest_feels_what_holds_it_up_in_every_engine(engine, hangar):
    simulation, felt = spinning(hangar, {"rate": 1000}, engine)
    row = rows_of(simulation, "imu", 50)[-1]
    assert np.allclose(row[1:7], felt, rtol=0, atol=0.05)


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_in_the_engines_of_ode_a_unit_measures_the_rate_at_the_end_of_a_step(engine, hangar):
    simulation, _ = spinning(hangar, {"rate": 1000}, engine)
    state = simulation.state.copy()
    state.angular_velocity = (8.0, -5.0, 3.0)  # about no axis of the inertia, so that it changes
    simulation.set_state(state)
    R_FS = Rotation.from_euler("xyz", RPY)
    row = rows_of(simulation, "imu", 3)[-1]
    w_end = R_FS.inv().apply(simulation.state.angular_velocity.copy())
    simulation.set_state(state)
    simulation.step(2)
    w_begin = R_FS.inv().apply(simulation.state.angular_velocity.copy())
    assert np.linalg.norm(row[1:4] - w_end) < 0.05 * np.linalg.norm(w_end - w_begin)
    (unit,) = (plugin for plugin in simulation.plugins if plugin.filename == "libimu_plugin.so")
    assert (
        "In gazebo11 and ode it measures the angular velocity at the end of each step"
        in unit.summary
    )


def still_unit(hangar, tags, seconds, seed=0, dt=0.01):
    """Errors of a unit that floats at rest: (n, 6)."""
    simulation = hangar(
        make_mounted("imu", {"rate": 1 / dt, **tags}), engine="eigen", dt=dt, seed=seed
    )
    imu = simulation.run(seconds, topics=["imu"]).topics["imu"]
    return np.column_stack([imu[f] for f in ("wx", "wy", "wz", "ax", "ay", "az")])[1:]


# Of gyroscopes and accelerometers: N, sigma and T_c of the drift, K. Each rules at one time.
ERRORS = {"gyro": (0.01, 0.05, 2, 0.007), "accelerometer": (0.12, 0.8, 3, 0.1)}


def test_errors_of_a_unit_have_the_allan_deviation_of_its_data_sheet(hangar):
    tags = {}
    for name, numbers in ERRORS.items():
        tags.update(zip((name + tag for tag in ("Noise", "Drift", "DriftTime", "Walk")), numbers))
    seconds, dt = 20000, 0.1
    errors = still_unit(hangar, tags, seconds=seconds, dt=dt)
    for column, of_one in enumerate(errors.T):
        N, sigma, T_c, K = ERRORS["gyro" if column < 3 else "accelerometer"]
        for ruling, n in enumerate((1, round(1.89 * T_c / dt), 1500)):
            tau = n * dt
            weights = np.repeat([-1.0, 1.0], n) / n
            lags = np.abs(np.arange(1 - 2 * n, 2 * n)) * dt
            drift = np.correlate(weights, weights, "full") @ np.exp(-lags / T_c) / 2
            # Walk and drift are sampled.
            shares = [N**2 / tau, sigma**2 * drift, K**2 * tau / 3 * (1 + 1 / (2 * n * n))]
            assert shares[ruling] > 0.85 * sum(shares)
            if ruling == 1:
                assert math.sqrt(drift) == pytest.approx(0.618, rel=0.01)
            _, (found,), _, _ = allantools.oadev(of_one, 1 / dt, data_type="freq", taus=[tau])
            tolerance = 3 / math.sqrt(2 * (seconds / tau - 1))
            print(column, tau, found / math.sqrt(sum(shares)), "+-", tolerance)
            assert found == pytest.approx(math.sqrt(sum(shares)), rel=tolerance)


def test_a_bias_is_one_for_a_flight_and_another_for_another(hangar):
    biases = []
    for seed in range(200):
        errors = still_unit(hangar, {"gyroBias": 0.1, "accelerometerBias": 2}, 0.05, seed)
        assert np.allclose(errors, errors[0], rtol=0, atol=1e-15)
        biases.append(errors[0])
    deviations = np.std(biases, axis=0)
    assert np.allclose(deviations, [0.1] * 3 + [2] * 3, rtol=3 / math.sqrt(400))
