"""A sensor mounted anywhere feels the mean specific force over its period."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import (
    with_fixed_link,
    with_plugins,
)
from scipy.spatial.transform import Rotation
from vehicles import SKEW, plugin, start, vehicle

pytestmark = pytest.mark.usefixtures("hook_plugins")


def spinning_drop(hangar, engine, rate):
    """A body that falls and turns about one of its axes, a sensor mounted askew on it."""
    at, rpy = (0.11, -0.07, 0.05), (0.4, -0.7, 1.1)
    urdf = vehicle((), mass=1.3, inertia=SKEW, com=(0.01, -0.02, 0.03))
    urdf = with_fixed_link(urdf, "imu", 0.05, (1e-5, 2e-5, 2.5e-5), at, rpy)
    urdf = with_plugins(urdf, plugin("accelerometer", {"link": "imu", "rate": rate}))
    simulation = hangar(urdf, (0.3, -0.2, -9.7), spawn=(1, 2, 3, 0.3, 0.2, 0.1), engine=engine)
    axis = np.linalg.eigh(simulation.inertia)[1][:, 2]
    w_F = 4.0 * axis  # about a principal axis of the whole: it stays
    R_WF = Rotation.from_quat(simulation.state.orientation.copy())
    c = simulation.center_of_mass
    start(
        simulation,
        angular_velocity=w_F,
        linear_velocity=np.array([1, -2, 0.5]) - R_WF.apply(np.cross(w_F, c)),
    )
    r_F = np.array(at) - c
    R_FS = Rotation.from_euler("xyz", rpy)

    def mean_force(begin, end):
        """The centripetal force of the circle about the centre of mass: gravity is not felt."""
        w_W = R_WF.apply(w_F)

        def velocity(t):
            return np.cross(w_W, (R_WF * Rotation.from_rotvec(w_F * t)).apply(r_F))

        f_W = (velocity(end) - velocity(begin)) / (end - begin)
        return (R_WF * Rotation.from_rotvec(w_F * end) * R_FS).inv().apply(f_W)

    return simulation, mean_force


@pytest.mark.parametrize("rate", [1000, 200])
def test_a_sensor_on_a_tilted_link_feels_the_mean_specific_force(rate, hangar):
    simulation, mean_force = spinning_drop(hangar, "eigen", rate)
    assert simulation.topic("specific_force")["count"] == 0  # no time has passed
    worst = 0.0
    for _ in range(100):
        simulation.step(1000 // rate)
        message = simulation.topic("specific_force")
        assert message["stamp"] == simulation.time
        felt = np.array([message[axis] for axis in "xyz"])
        expected = mean_force(simulation.time - 1 / rate, simulation.time)
        worst = max(worst, np.linalg.norm(felt - expected) / np.linalg.norm(expected))
    print("worst", worst)
    assert worst < 1e-9


@pytest.mark.parametrize("engine", ENGINES)
def test_every_engine_lets_a_sensor_feel_it(engine, hangar):
    simulation, mean_force = spinning_drop(hangar, engine, 1000)
    simulation.step(50)
    felt = simulation.topic("specific_force")
    expected = mean_force(simulation.time - 1e-3, simulation.time)
    assert np.allclose([felt[axis] for axis in "xyz"], expected, rtol=0, atol=0.05)
