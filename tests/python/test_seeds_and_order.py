"""Seeds that a reset can change; the order of plugins in the URDF, which does not matter."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from flights import BUSY, ENGINES, bits, quadrotor
from hooked import (
    CHAPTER2,
    G,
    assert_same_bytes,
    fly,
    make_motored,
    with_plugins,
)
from vehicles import MOTOR, ODD, SKEW, plugin, vehicle

import quadcore as qc

pytestmark = pytest.mark.usefixtures("hook_plugins")


@pytest.mark.parametrize("engine", ENGINES)
def test_where_the_urdf_has_its_plugins_does_not_matter(engine, hangar):
    urdf = vehicle(ODD, inertia=SKEW, com=(0.01, -0.02, 0.03))
    plugins = [
        plugin("aerodynamic", CHAPTER2),
        plugin("motorpid", MOTOR),
        plugin("buffet", {"deviation": 0.3}),
        plugin("gust", {"x": 1.1, "y": 0.3}).replace('"gust"', '"morning"'),
        plugin("gust", {"x": 0.1, "z": 0.7}).replace('"gust"', '"evening"'),
    ]
    logs = [
        fly(hangar(with_plugins(urdf, *order), G, engine=engine, seed=3), 100)
        for order in itertools.islice(itertools.permutations(plugins), 0, None, 17)
    ]
    for log in logs[1:]:
        assert_same_bytes(logs[0], log)
        assert list(log.wrenches) == list(logs[0].wrenches)


@pytest.mark.parametrize("engine", ENGINES)
def test_where_the_urdf_has_the_shipped_plugins_does_not_matter(engine, hangar):
    urdf = vehicle(ODD, inertia=SKEW, com=(0.01, -0.02, 0.03))
    plugins = [
        plugin("aerodynamic", CHAPTER2),
        plugin("motor", {"delay": 0.003}),
        plugin("odometry", {"positionNoise": 0.1, "delay": 0.01}),
        plugin("imu", {"gyroNoise": 0.01, "dropout": 0.2}),
        plugin("gps", {"horizontalNoise": 0.5}),
        plugin("wind", {"velocity": "3 -2 1", "turbulence": 15}),
        plugin("payload", {"mass": 0.2, "release": 0.05}),
        plugin("fault", {"losses": "0.03 2 0.5", "cuts": "0.07 1"}),
        plugin("push", {"link": "propeller3"}),
    ]
    logs = []
    for turn in range(0, len(plugins), 2):
        order = plugins[turn:] + plugins[:turn][::-1]
        simulation = hangar(with_plugins(urdf, *order), G, engine=engine, seed=3)
        simulation.publish("push", [1, -2, 0.5, 0.01, 0.02, -0.03])
        simulation.command((471, -465, 480, -475))
        logs.append(simulation.run(0.1, topics=["odom", "imu", "fix", "wind", "power"]))
    for log in logs[1:]:
        assert_same_bytes(logs[0], log)
        for name, rows in logs[0].topics.items():
            for field in rows:
                assert log.topics[name][field].tobytes() == rows[field].tobytes(), (name, field)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_reset_with_a_seed_is_a_new_simulation_with_it(engine, hangar):
    urdf = with_plugins(
        make_motored(),
        plugin("buffet", {"deviation": 0.2}),
        plugin("odometry", {"positionNoise": 0.1}),
    )

    def fly_on(simulation):
        log = fly(simulation, 200)
        return log, simulation.topic("odom")

    simulation = hangar(urdf, G, engine=engine, seed=1)
    fly_on(simulation)
    seeds = (5, 2**64 - 1, np.int64(7))
    for seed in seeds:
        simulation.reset(seed=seed)
        log, odom = fly_on(simulation)
        fresh, seen = fly_on(hangar(urdf, G, engine=engine, seed=seed))
        assert_same_bytes(log, fresh)
        assert odom == seen
    simulation.reset()  # keeps it
    assert_same_bytes(fly_on(simulation)[0], log)
    assert fly_on(hangar(urdf, G, engine=engine, seed=1))[0].table.tobytes() != log.table.tobytes()


def test_a_snapshot_brings_its_seed_back():
    noisy = quadrotor(parameters=BUSY, seed=11)
    noisy.step(20)
    snapshot = noisy.snapshot()
    noisy.step(50)
    expected = bits(noisy)
    noisy.reset(seed=12)
    noisy.step(70)
    assert bits(noisy) != expected
    noisy.restore(snapshot)
    noisy.step(50)
    assert bits(noisy) == expected


@pytest.mark.parametrize("seed", [-1, 1.5, "1", 2**64])
def test_a_seed_that_is_none_is_refused_by_reset(seed):
    with pytest.raises(qc.InputError, match=r"seed is .*\. Give a whole number from 0 to"):
        quadrotor().reset(seed=seed)


def test_each_plugin_has_a_seed_of_its_own(hangar):
    def read_bits(name, seed):
        element = plugin("probe", {}).replace('name="probe"', f'name="{name}"')
        simulation = hangar(with_plugins(vehicle(()), element), seed=seed)
        return simulation.topic("seen")["bits"]

    assert len({read_bits(name, seed) for name in ("one", "other") for seed in (0, 1)}) == 4
    assert read_bits("one", 0) == read_bits("one", 0)
