"""Turbulence of libwind_plugin.so: Dryden's, as MIL-F-8785C has it for low altitude."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from flights import ENGINES
from hooked import G, assert_same_bytes, fly, make_motored, with_plugins
from scipy.signal import welch
from vehicles import plugin, start, vehicle

MODERATE = 15.433  # m/s: 30 kt
# Of MIL-F-8785C at 10 m and W20 = 30 kt.
LENGTH = {"u": 67.365951, "v": 67.365951, "w": 10.0}
SIGMA = {"u": 1.888630 * 0.1 * MODERATE, "v": 1.888630 * 0.1 * MODERATE, "w": 0.1 * MODERATE}
AIRSPEED = 5.0
RATE = 50  # samples per second: at a tenth of it the folded spectrum is still near the true one


def add_wind(urdf, **tags):
    return with_plugins(urdf, plugin("wind", tags))


def spectrum(component, f):
    """One-sided, per Hz; what lies above half the rate of the samples is folded down."""
    length, sigma = LENGTH[component], SIGMA[component]
    folded = 0.0
    for k in range(-40, 41):
        x2 = (2 * np.pi * (f + RATE * k) * length / AIRSPEED) ** 2
        shape = 2 / (1 + x2) if component == "u" else (1 + 3 * x2) / (1 + x2) ** 2
        folded = folded + sigma**2 * length / (np.pi * AIRSPEED) * shape * 2 * np.pi
    return folded


@pytest.fixture(scope="module")
def turbulence(tmp_path_factory):
    """What 20 flights of 1000 s at rest felt: (seed, time, u v w)."""
    from vehicles import Hangar

    urdf = add_wind(vehicle(()), turbulence=MODERATE, height=10, airspeed=AIRSPEED)
    simulation = Hangar(tmp_path_factory.mktemp("wind"))(urdf, engine="eigen", dt=1 / RATE)
    rows = []
    for seed in range(20):
        simulation.reset(seed=seed)
        wind = simulation.run(1000, topics=["wind"]).topics["wind"]
        rows.append(np.column_stack([wind[axis] for axis in "xyz"])[1:])
    return np.array(rows)


@pytest.mark.parametrize(("component", "share"), [("u", 1), ("v", 5 / 8), ("w", 5 / 8)])
def test_turbulence_has_the_variance_of_dryden(component, share, turbulence):
    x = turbulence[..., "uvw".index(component)]
    deviation = math.sqrt(2 * share * LENGTH[component] / AIRSPEED / 20000)
    ratio = np.mean(x**2) / SIGMA[component] ** 2
    print(component, "variance", ratio, "+-", deviation)
    assert abs(ratio - 1) < 3 * deviation
    # It has no beginning: the first second varies as much.
    assert np.mean(x[:, :RATE] ** 2) / SIGMA[component] ** 2 == pytest.approx(1, abs=1.5)


@pytest.mark.parametrize("component", ["u", "v", "w"])
def test_turbulence_has_the_spectrum_of_dryden(component, turbulence):
    x = turbulence[..., "uvw".index(component)]
    f, density = welch(x, fs=RATE, nperseg=2**14, detrend=False)
    density = density.mean(axis=0)
    for low in 0.02 * 2.0 ** np.arange(8):  # to 5.12 Hz
        band = (f >= low) & (f < 2 * low)
        ratio = density[band].sum() / spectrum(component, f[band]).sum()
        print(component, f"{low:.2f} Hz", ratio)
        assert abs(ratio - 1) < 3 / math.sqrt(20000 * low)
        assert low < 0.16 or abs(ratio - 1) < 0.05


def test_components_of_the_turbulence_have_nothing_to_do_with_each_other(turbulence):
    u, v, w = np.moveaxis(turbulence, -1, 0)
    for one, other, tau in ((u, v, 13.5), (u, w, 2), (v, w, 2)):
        correlation = np.mean(one * other) / math.sqrt(np.mean(one**2) * np.mean(other**2))
        assert abs(correlation) < 4 * math.sqrt(2 * tau / 20000)


@pytest.mark.parametrize("engine", ENGINES)
def test_turbulence_is_a_matter_of_the_seed_and_survives_a_snapshot(engine, hangar):
    urdf = add_wind(make_motored(), velocity="4 -3 0", turbulence=MODERATE)
    simulation = hangar(urdf, G, engine=engine, seed=3)
    fly(simulation, 100)
    middle = simulation.snapshot()
    second = fly(simulation, 200)
    simulation.restore(middle)
    assert_same_bytes(second, fly(simulation, 200))
    simulation.reset(seed=3)
    fly(simulation, 100)
    assert_same_bytes(second, fly(simulation, 200))
    simulation.reset(seed=4)
    fly(simulation, 100)
    assert fly(simulation, 200).table.tobytes() != second.table.tobytes()


def test_every_engine_meets_the_same_turbulence(hangar):
    urdf = add_wind(make_motored(), velocity="4 -3 0", turbulence=MODERATE)
    rows = []
    for engine in ENGINES:
        simulation = hangar(urdf, G, engine=engine, seed=3)
        rows.append(simulation.run(0.3, topics=["wind"]).topics["wind"])
    for axis, other in itertools.product("xyz", rows[1:]):
        assert rows[0][axis].tobytes() == other[axis].tobytes()


def test_u_blows_along_the_relative_wind_at_its_speed(hangar):
    # In a wind from the north-east at 2 m/s that meets the vehicle at 10, w of a length of 10 m
    # forgets within about a second.
    urdf = add_wind(vehicle(()), velocity="3 4 0", turbulence=MODERATE, airspeed=0.1)
    simulation = hangar(urdf, engine="eigen", dt=0.01)

    def ratio(velocity):
        along, across = [], []
        for seed in range(60):
            simulation.reset(seed=seed)
            start(simulation, linear_velocity=velocity)
            wind = simulation.run(40, topics=["wind"]).topics["wind"]
            level = np.column_stack([wind["x"] - 3, wind["y"] - 4])[1:]
            direction = np.array([3, 4]) - np.array(velocity[:2])
            direction = direction / np.linalg.norm(direction)
            along.append(np.diff(level @ direction))
            across.append(np.diff(level @ np.array([-direction[1], direction[0]])))
        return np.var(along), np.var(across)

    # Within a step dt, u changes by 2 sigma^2 V dt/L, v by 3 times half as much.
    for velocity in ((0, 0, 0), (9, -4, 0)):
        V = np.linalg.norm(np.array([3, 4, 0]) - velocity)
        along, across = ratio(velocity)
        expected = 2 * SIGMA["u"] ** 2 * V * 0.01 / LENGTH["u"]
        assert along == pytest.approx(expected, rel=0.02)
        assert across == pytest.approx(1.5 * expected, rel=0.02)
