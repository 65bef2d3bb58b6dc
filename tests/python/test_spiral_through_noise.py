"""The spiral of the thesis through noise of the odometry, worst of the seeds."""

from __future__ import annotations

import pytest
from flights import NOISE

import quadcore as qc

VELOCITIES = {"odometry.linearVelocityNoise": 5e-3, "odometry.angularVelocityNoise": 5e-3}


def find_max_error(engine, slow, noise, seeds):
    """Largest error of the last 10 s of all seeds, m."""
    found = qc.evaluate(
        "geometric", "spiral", engine, seeds=seeds, parameters=noise, xacro_args={"sim_slow": slow}
    )
    assert [row["failure"] for row in found.table] == [""] * seeds
    return max(row["final_position"] for row in found.table)


@pytest.mark.parametrize(
    ("engine", "slow", "seeds", "bar"),
    [
        ("eigen", 1, 20, 0.15e-3),
        ("ode", 1, 2, 0.5e-3),
        ("gazebo11", 1, 2, 0.9e-3),
        ("gazebo11", 10, 2, 0.5e-3),
    ],
)
def test_the_noise_of_the_thesis_leaves_it_close(engine, slow, seeds, bar):
    """scripts/fly_controllers.py flies 20 seeds of each."""
    assert 0 < find_max_error(engine, slow, NOISE, seeds) <= bar


@pytest.mark.parametrize(
    ("engine", "slow"), [("eigen", 1), ("ode", 1), ("gazebo11", 1), ("gazebo11", 10)]
)
def test_noisy_velocities_besides_leave_it_within_a_millimetre(engine, slow):
    assert 0.15e-3 < find_max_error(engine, slow, {**NOISE, **VELOCITIES}, 2) < 1e-3
