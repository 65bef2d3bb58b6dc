"""Force laws know the time of the stage; the air is the sum of the world's and the plugins'."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import CHAPTER2, G, assert_same_bytes, fly, make_motored, with_plugins
from scipy.spatial.transform import Rotation
from vehicles import ODD, SKEW, plugin, start, vehicle

pytestmark = pytest.mark.usefixtures("hook_plugins")


@pytest.mark.parametrize("engine", ENGINES)
def test_a_sensor_has_its_time_and_a_force_law_that_of_the_stage(engine, hangar):
    urdf = with_plugins(vehicle((), mass=2), plugin("probe", {"cube": 3}))
    simulation = hangar(urdf, gravity=(0, 0, -1.5), engine=engine, dt=0.01)
    start(simulation, time=0.2)
    for _ in range(100):
        simulation.step()
        seen = simulation.topic("seen")
        assert seen["time"] == simulation.time and seen["late"] == seen["g"] == 0
    # Simpson's rule is exact for a cube; a sum of impulses is not.
    velocity = 3 / 2 * (1.2**4 - 0.2**4) / 4
    impulses = 3 / 2 * 0.01 * sum((0.2 + 0.01 * i) ** 3 for i in range(100))
    expected = velocity if engine == "eigen" else impulses
    assert simulation.state.linear_velocity[0] == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_wind_by_plugin_is_the_worlds_bit_for_bit(engine, hangar):
    wind = {"x": 3.1, "y": -1.7, "z": 0.43}
    urdf = make_motored()
    probe = plugin("probe", {})
    by_world = hangar(
        with_plugins(urdf, probe),
        G,
        tuple(wind.values()),
        spawn=(0, 0, 5, 0.3, -0.2, 1),
        engine=engine,
    )
    by_plugin = hangar(
        with_plugins(urdf, plugin("gust", wind), probe),
        G,
        spawn=(0, 0, 5, 0.3, -0.2, 1),
        engine=engine,
    )
    for simulation in (by_world, by_plugin):
        simulation.set_state(simulation.state.copy())
    assert_same_bytes(fly(by_world, 1000), fly(by_plugin, 1000))
    assert by_world.topic("air") == by_plugin.topic("air")
    air = [by_plugin.topic("air")[axis] for axis in "xyz"]
    turned = Rotation.from_quat(by_plugin.state.orientation.copy()).apply(air)
    assert np.allclose(turned, list(wind.values()), rtol=0, atol=1e-13)
    still = fly(hangar(urdf, G, spawn=(0, 0, 5, 0.3, -0.2, 1), engine=engine), 1000)
    assert np.abs(still.position[-1] - by_world.run(0).position[0]).max() > 0.01


@pytest.mark.parametrize("engine", ENGINES)
def test_winds_of_world_and_plugins_add_up(engine, hangar):
    urdf = make_motored()
    halves = [plugin("gust", {"x": 1.5, "z": -0.25}).replace('"gust"', f'"{n}"') for n in "ab"]
    together = fly(hangar(with_plugins(urdf, *halves), G, (2, 3, 1), engine=engine), 300)
    assert_same_bytes(together, fly(hangar(urdf, G, (5, 3, 0.5), engine=engine), 300))


def test_a_gust_keeps_the_fourth_order_of_eigen(hangar):
    gust = {"x": 9, "y": -6, "z": 4, "begin": 0.128, "duration": 0.128}  # whole steps
    air = {**CHAPTER2, "inducedDragCoeff": 0.1, "parasiticDragCoeff": 0.03}
    urdf = vehicle(ODD, mass=0.3, inertia=SKEW, com=(0.01, -0.02, 0.03), air=air)

    def end(dt, *plugins):
        simulation = hangar(with_plugins(urdf, *plugins), G, engine="eigen", dt=dt)
        simulation.step(round(0.384 / dt))
        return simulation.state.position.copy()

    exact = end(0.0005, plugin("gust", gust))
    assert np.linalg.norm(exact - end(0.0005)) > 0.05
    errors = [np.linalg.norm(end(dt, plugin("gust", gust)) - exact) for dt in (0.016, 0.008, 0.004)]
    assert errors[0] > 12 * errors[1] and errors[1] > 12 * errors[2] and errors[2] > 1e-12
