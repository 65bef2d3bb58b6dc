"""libwind_plugin.so: mean wind, shear, gusts and turbulence; the density of the air."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from flights import ENGINES
from hooked import CHAPTER2, G, assert_same_bytes, fly, make_motored, with_plugins
from vehicles import AIR, DRAG, MOTOR, ODD, SKEW, plugin, start, text, vehicle, wrenches

import quadcore as qc


def add_wind(urdf, **tags):
    return with_plugins(urdf, plugin("wind", tags))


def measure_wind(simulation):
    """Velocity of the air where the vehicle is."""
    wind = simulation.topic("wind")
    return np.array([wind[axis] for axis in "xyz"])


@pytest.mark.parametrize("engine", ENGINES)
def test_a_constant_wind_is_the_worlds_bit_for_bit(engine, hangar):
    wind = (3.1, -1.7, 0.43)
    options = {"spawn": (0, 0, 5, 0.3, -0.2, 1), "engine": engine}
    by_world = hangar(make_motored(), G, wind, **options)
    by_plugin = hangar(add_wind(make_motored(), velocity=text(wind)), G, **options)
    assert_same_bytes(fly(by_world, 1000), fly(by_plugin, 1000))
    assert measure_wind(by_plugin).tolist() == list(wind)
    still = fly(hangar(make_motored(), G, **options), 1000)
    assert np.abs(still.position[-1] - by_world.state.position).max() > 0.01


def test_a_message_replaces_the_mean_wind(hangar):
    options = {"spawn": (0, 0, 5, 0.3, -0.2, 1), "engine": "eigen"}
    by_tag = hangar(add_wind(make_motored(), velocity="3.1 -1.7 0.43", shear="power"), G, **options)
    by_message = hangar(add_wind(make_motored(), velocity="1 1 1", shear="power"), G, **options)
    by_message.publish("wind_velocity", [3.1, -1.7, 0.43])
    assert fly(by_tag, 500).table.tobytes() == fly(by_message, 500).table.tobytes()
    by_message.publish("wind_velocity", [0, 0, 0])
    by_message.step()
    assert measure_wind(by_message).tolist() == [0, 0, 0]
    by_message.reset(0)
    by_message.step()
    height = by_message.state.position[2]
    assert np.allclose(measure_wind(by_message), (height / 6.096) ** (1 / 7), rtol=1e-12)


def test_a_gust_keeps_the_fourth_order_of_eigen(hangar):
    gusts = "9 -6 4 0.128 0.128  -3 2 1 0.192 0.128"  # in whole steps
    air = {**CHAPTER2, "inducedDragCoeff": 0.1, "parasiticDragCoeff": 0.03}
    urdf = vehicle(ODD, mass=0.3, inertia=SKEW, com=(0.01, -0.02, 0.03), air=air)

    def end(dt, **tags):
        simulation = hangar(add_wind(urdf, **tags), G, engine="eigen", dt=dt)
        simulation.step(round(0.384 / dt))
        return simulation.state.position.copy()

    exact = end(0.0005, gusts=gusts)
    assert np.linalg.norm(exact - end(0.0005)) > 0.05
    errors = [np.linalg.norm(end(dt, gusts=gusts) - exact) for dt in (0.016, 0.008, 0.004)]
    print("errors", errors)
    assert errors[0] > 12 * errors[1] and errors[1] > 12 * errors[2] and errors[2] > 1e-12


def test_gusts_add_to_the_mean_wind_within_their_time(hangar):
    gusts = ((4, -2, 1, 0.1, 0.3), (0, 5, 0, 0.25, 0.2))
    simulation = hangar(
        add_wind(vehicle(()), velocity="1 2 3", gusts=" ".join(map(text, gusts))), engine="eigen"
    )
    for _ in range(500):
        simulation.step()
        expected = np.array([1.0, 2, 3])
        for *V, begin, duration in gusts:
            t = simulation.time - begin
            if 0 < t < duration:
                expected += np.array(V) / 2 * (1 - math.cos(2 * math.pi * t / duration))
        assert np.allclose(measure_wind(simulation), expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("tags", "factor"),
    [
        ({"shear": "power"}, lambda z: (z / 6.096) ** (1 / 7) if z > 0 else 0),
        (
            {"shear": "power", "exponent": 0.3, "referenceHeight": 10},
            lambda z: max(z, 0) ** 0.3 / 10**0.3,
        ),
        (
            {"shear": "logarithmic"},
            lambda z: math.log(z / 0.04572) / math.log(6.096 / 0.04572) if z > 0.04572 else 0,
        ),
        (
            {"shear": "logarithmic", "roughness": 0.5, "referenceHeight": 20},
            lambda z: math.log(z / 0.5) / math.log(40) if z > 0.5 else 0,
        ),
    ],
)
def test_shear_lets_the_wind_grow_with_the_height_of_the_frame(tags, factor, hangar):
    simulation = hangar(add_wind(vehicle(()), velocity="4 -3 0.5", **tags), engine="eigen")
    for z in (-1, 0, 0.04, 0.3, 1, 6.096, 20, 300):
        start(simulation, position=(1, 2, z))
        expected = np.array([4, -3, 0.5]) * factor(z)
        assert np.allclose(measure_wind(simulation), expected, rtol=1e-14, atol=0), z


@pytest.mark.parametrize("engine", ENGINES)
def test_where_the_urdf_has_two_winds_does_not_matter(engine, hangar):
    elements = [
        plugin("wind", {"velocity": "1.1 0.3 0", "turbulence": 7.7, "topic": name}).replace(
            '"wind"', f'"{name}"'
        )
        for name in ("morning", "evening")
    ]
    elements += [plugin("aerodynamic", CHAPTER2), plugin("motorpid", MOTOR)]
    urdf = vehicle(ODD, inertia=SKEW)
    logs = [
        fly(hangar(with_plugins(urdf, *order), G, engine=engine, seed=3), 100)
        for order in itertools.islice(itertools.permutations(elements), 0, None, 5)
    ]
    for log in logs[1:]:
        assert_same_bytes(logs[0], log)


@pytest.mark.parametrize("by", ["world", "plugin"])
@pytest.mark.parametrize(("model", "times"), [("appendix", 1), ("chapter2", 0)])
def test_a_wind_without_effect_is_reported_once(by, model, times, hangar, recwarn):
    urdf = vehicle(air={**AIR, **DRAG, "dragModel": model})
    if by == "plugin":
        simulation = hangar(add_wind(urdf, gusts="3 0 0 0.01 0.05"))
    else:
        simulation = hangar(urdf, wind=(3, 0, 0))
    simulation.step(100)
    messages = [warning for warning in simulation.warnings if "ignores wind" in warning]
    assert len(messages) == times
    if messages:
        assert "Set <dragModel> to chapter2" in messages[0]


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ({"gusts": "1 2 3 4"}, "<gusts> has 4 numbers. Write five for each gust"),
        ({"gusts": "1 2 3 0 1 1 2 3 -1 1"}, "gust 2 of <gusts> starts before the flight"),
        ({"gusts": "1 2 3 0 0"}, "gust 1 of <gusts> starts before the flight or has no duration"),
        ({"shear": "logarithmic", "roughness": 7}, "<roughness> is not below <referenceHeight>"),
    ],
)
def test_a_wind_that_cannot_be_is_refused_with_its_line(tags, says, hangar):
    urdf = add_wind(vehicle(()), **tags)
    line = 1 + urdf[: urdf.index("libwind")].count("\n")
    with pytest.raises(qc.InputError, match=f"urdf:{line}: plugin 'wind' .*{says}"):
        hangar(urdf)


def test_a_shear_without_wind_is_reported(hangar):
    with pytest.warns(qc.QuadcoreWarning, match="<shear> has no effect while <velocity> is 0"):
        hangar(add_wind(vehicle(()), shear="power"))


def test_thin_air_scales_thrust_torque_and_drag(tmp_path):
    urdf = vehicle(ODD, air={**CHAPTER2, "airDensity": 1.225}, inertia=SKEW)
    (tmp_path / "a.urdf").write_text(urdf)
    (tmp_path / "a.world").write_text(
        "<sdf><world><atmosphere type='adiabatic'><temperature>298.15</temperature>"
        "<pressure>84550.7</pressure></atmosphere></world></sdf>"
    )

    def compute_wrenches(**options):
        simulation = qc.Simulation(tmp_path / "a.urdf", **options)
        return wrenches(
            start(
                simulation,
                linear_velocity=(3, -2, 1),
                angular_velocity=(0.3, 0.2, 0.1),
                rotor_velocity=(471, -465, 480, -475),
            )
        )

    standard, thin = compute_wrenches(), compute_wrenches(world=tmp_path / "a.world")
    density = 84550.7 / (287.05287 * 298.15)
    for term, wrench in standard.items():
        assert np.abs(wrench).max() > 0
        # The standard atmosphere's density has more digits than the tag.
        ratio = density / (101325 / (287.05287 * 288.15))
        assert np.allclose(thin[term], ratio * wrench, rtol=1e-13, atol=1e-16), term
    without = urdf.replace("<airDensity>1.225</airDensity>", "")
    (tmp_path / "a.urdf").write_text(without)
    as_is, same = compute_wrenches(), compute_wrenches(world=tmp_path / "a.world")
    for term, wrench in as_is.items():
        assert wrench.tobytes() == same[term].tobytes()
        assert np.allclose(standard[term], wrench, rtol=1e-5, atol=1e-16)
