"""Topic odom: the truth of the frame, at its rate, with the noise its tags ask for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from flights import BUSY, HOVER, quadrotor
from scipy.spatial.transform import Rotation
from sensed import make_mounted

import quadcore as qc

POSE = ("x", "y", "z", "qx", "qy", "qz", "qw")
LINEAR = ("vx", "vy", "vz")
ANGULAR = ("wx", "wy", "wz")
NOISE = {"position": 0.1, "orientation": 0.02, "linear_velocity": 0.3, "angular_velocity": 0.4}
TAGS = {
    "odometry.positionNoise": 0.1,
    "odometry.orientationNoise": 0.02,
    "odometry.linearVelocityNoise": 0.3,
    "odometry.angularVelocityNoise": 0.4,
}


def start_tumbling(**parameters):
    simulation = quadrotor(parameters=parameters, spawn=(1, 2, 3, 0.4, -0.3, 2))
    simulation.command(HOVER * [1, 1.01, 1.02, 1])
    return simulation


def part(message, names):
    return np.array([message[name] for name in names])


def errors(simulation, steps):
    """Message minus truth, per quantity; rows of three."""
    found = {name: [] for name in NOISE}
    for _ in range(steps):
        simulation.step()
        message, state = simulation.topic("odom"), simulation.state
        pose = part(message, POSE)
        truth = Rotation.from_quat(state.orientation.copy())
        found["position"].append(pose[:3] - state.position)
        found["orientation"].append((truth.inv() * Rotation.from_quat(pose[3:])).as_rotvec())
        found["linear_velocity"].append(part(message, LINEAR) - state.linear_velocity)
        found["angular_velocity"].append(part(message, ANGULAR) - state.angular_velocity)
    return {name: np.array(rows) for name, rows in found.items()}


def test_without_noise_a_message_is_the_truth():
    for rows in errors(start_tumbling(), 200).values():
        assert np.abs(rows).max() < 1e-15


def test_a_noise_tag_is_the_standard_deviation_of_each_component():
    simulation = start_tumbling(**TAGS)
    steps = 4000
    found = errors(simulation, steps)
    for name, deviation in NOISE.items():
        rows = found[name] / deviation
        assert simulation.topic("odom")[f"{name}_variance"] == deviation**2
        # Five standard errors of the mean, the deviation and the correlation.
        assert np.abs(rows.mean(axis=0)).max() < 5 / np.sqrt(steps)
        assert np.abs(rows.std(axis=0) - 1).max() < 5 / np.sqrt(2 * steps)
    every = np.hstack([found[name] for name in NOISE])
    correlation = np.corrcoef(np.vstack([every[1:].T, every[:-1].T]))
    assert np.abs(correlation - np.eye(len(correlation))).max() < 5 / np.sqrt(steps)


def test_noise_of_one_quantity_leaves_the_others_true():
    found = errors(start_tumbling(**{"odometry.linearVelocityNoise": 0.3}), 100)
    assert found.pop("linear_velocity").std() > 0.1
    for rows in found.values():
        assert np.abs(rows).max() < 1e-15


def test_a_noisy_orientation_is_a_unit_quaternion():
    simulation = start_tumbling(**{"odometry.orientationNoise": 1})
    for _ in range(100):
        simulation.step()
        assert np.linalg.norm(part(simulation.topic("odom"), POSE[3:])) == pytest.approx(1)


def test_the_twist_may_be_given_in_body_axes():
    world, body = start_tumbling(), start_tumbling(**{"odometry.twistFrame": "body"})
    for simulation in (world, body):
        simulation.step(500)
    state = world.state.copy()
    turned = Rotation.from_quat(state.orientation).inv().apply(state.linear_velocity)
    message = body.topic("odom")
    assert np.allclose(part(message, LINEAR), turned, rtol=0, atol=1e-14)
    assert not np.allclose(part(message, LINEAR), part(world.topic("odom"), LINEAR), atol=0.1)
    assert np.array_equal(part(message, ANGULAR), part(world.topic("odom"), ANGULAR))


@pytest.mark.parametrize(
    ("controller", "who"),
    [
        ("geometric", "controller 'geometric'"),
        (lambda t, state, reference: qc.AttitudeThrust((0, 0, 0, 1), 10.0), "inner loop"),
    ],
)
def test_who_needs_velocities_in_the_world_refuses_those_in_body_axes(controller, who):
    simulation = start_tumbling(**{"odometry.twistFrame": "body"})
    with pytest.raises(qc.QuadcoreError, match=f"{who} requires velocities in world axes"):
        simulation.run(0.1, controller=controller, reference="hover")


@pytest.mark.parametrize("tag", ["rate", "updateRate"])
def test_messages_come_at_their_rate_from_time_zero_on(tag):
    simulation = quadrotor(parameters={f"odometry.{tag}": 400})
    stamps = [simulation.topic("odom")["stamp"]]
    for _ in range(1000):
        simulation.step()
        stamps.append(simulation.topic("odom")["stamp"])
    assert simulation.topic("odom")["count"] == 401
    due = np.arange(401) / 400
    # Each at the end of the step in which it is due.
    assert np.allclose(np.unique(stamps), np.ceil(due * 1000 - 1e-6) / 1000, rtol=0, atol=1e-12)


def test_at_most_one_message_comes_per_step():
    simulation = quadrotor(parameters={"odometry.rate": 5000})
    simulation.step(10)
    assert simulation.topic("odom")["count"] == 11


def test_its_own_seed_makes_the_noise_independent_of_the_simulations():
    def fly(seed, **parameters):
        simulation = quadrotor(seed=seed, parameters={**BUSY, **parameters})
        simulation.step(100)
        return simulation.topic("odom")

    own = {"odometry.seed": 5}
    assert fly(1, **own) == fly(2, **own)
    assert fly(1) != fly(2)
    assert fly(5) == fly(1, **own)


def test_a_state_that_is_set_is_sensed_at_once():
    simulation = quadrotor(parameters={"odometry.rate": 1})
    simulation.step(300)
    state = simulation.state.copy()
    state.position[:] = 7, 8, 9
    simulation.set_state(state)
    message = simulation.topic("odom")
    assert message["stamp"] == 0.3
    assert part(message, POSE[:3]).tolist() == [7, 8, 9]


def odometry_at_rest(hangar, seconds=100, **tags):
    simulation = hangar(make_mounted("odometry", tags), spawn=(1, 2, 3), engine="eigen", dt=0.01)
    odom = simulation.run(seconds, topics=["odom"]).topics["odom"]
    return {name: np.array(odom[name]) for name in odom}


def test_the_bias_of_odometry_walks(hangar):
    found = []
    for seed in range(30):
        simulation = hangar(
            make_mounted("odometry", {"positionWalk": 0.2, "orientationWalk": 1e-3}),
            engine="eigen",
            dt=0.01,
            seed=seed,
        )
        odom = simulation.run(10, topics=["odom"]).topics["odom"]
        for walk, scale in ((odom["x"], 0.2), (odom["y"], 0.2), (odom["qz"], 0.5e-3)):
            assert walk[0] == 0
            found.append(np.diff(walk[1:]) / scale)
    assert np.std(found) == pytest.approx(math.sqrt(0.01), rel=0.02)


def test_odometry_is_rounded_to_its_resolution(hangar):
    odom = odometry_at_rest(
        hangar, positionNoise=0.3, positionResolution=0.25, angularVelocityResolution=0.5
    )
    steps = odom["x"] / 0.25
    assert np.array_equal(steps, np.round(steps)) and len(np.unique(steps)) > 3
    assert odom["position_variance"][0] == pytest.approx(0.3**2 + 0.25**2 / 12, rel=1e-15)
    assert odom["angular_velocity_variance"][0] == pytest.approx(0.5**2 / 12, rel=1e-15)
    assert np.var(odom["x"]) == pytest.approx(0.3**2 + 0.25**2 / 12, rel=0.05)


@pytest.mark.parametrize("rate", [990, 900, 800, 1000, 333])
@pytest.mark.parametrize("delay", [0.0011, 0.0101, 0.0105, 0.0212])
def test_a_delay_that_is_no_whole_number_of_steps_loses_no_message(rate, delay, hangar):
    simulation = hangar(make_mounted("odometry", {"rate": rate, "delay": delay}), engine="eigen")
    simulation.step(200)
    arrived = simulation.topic("odom")["count"]
    assert arrived >= math.floor((0.2 - delay - 0.0021) * rate)
