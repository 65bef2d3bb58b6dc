"""libceiling_effect_plugin.so: thrust below an obstacle, solved apart from the plugin's formula."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import with_plugins
from scipy.optimize import brentq
from vehicles import CROSS, LIFT, ODD, plugin, start, vehicle, wrenches

import quadcore as qc

RADIUS = 0.1  # m
LOSS = 1.2
DENSITY = 101325 / (287.05287 * 288.15)  # kg/m^3, of the standard atmosphere
AREA = np.pi * RADIUS**2
UNDERSIDE = 5.0  # m


@pytest.fixture
def below_a_ceiling(tmp_path):
    """A function that returns a simulation of rotors below a box 4 m square."""

    def simulate(rotors=CROSS, **options):
        tags = {"rotorRadius": RADIUS, "advanceRatioLoss": LOSS}
        urdf = vehicle(rotors, air={**LIFT, "inducedDragCoeff": 0, "sim_slow": 2})
        (tmp_path / "a.urdf").write_text(with_plugins(urdf, plugin("ceiling_effect", tags)))
        (tmp_path / "a.world").write_text(
            '<sdf><world><model name="ceiling"><static>true</static>'
            f'<pose>0 0 {UNDERSIDE + 0.5} 0 0 0</pose><link name="l"><collision name="c"><geometry>'
            "<box><size>4 4 1</size></box></geometry></collision></link></model></world></sdf>"
        )
        return qc.Simulation(tmp_path / "a.urdf", world=tmp_path / "a.world", **options)

    return simulate


def solve_thrust(thrust, speed, distance):
    """Thrust at a distance from the ceiling, N, by momentum theory and a linear blade."""

    def inflow(given):
        return np.sqrt(given / (2 * DENSITY * AREA))

    v0 = inflow(thrust)

    def blade(slope, v):
        return thrust + slope * (v0 - v)

    def climb_loss(slope):
        """Relative loss of thrust per advance ratio in a slow flow against the rotor."""
        V = 1e-4  # m/s
        induced = brentq(
            lambda v: 2 * DENSITY * AREA * v * (v + V) - blade(slope, v + V), 0, 10 * v0, xtol=1e-15
        )
        advance_ratio = V / (speed / (2 * np.pi) * 2 * RADIUS)
        return (thrust - blade(slope, induced + V)) / thrust / advance_ratio

    slope = brentq(lambda s: climb_loss(s) - LOSS, 1e-6, 1e3)
    gamma = 0.5 + 0.5 * np.sqrt(1 + (RADIUS / distance) ** 2 / 8)
    return brentq(lambda T: blade(slope, inflow(T) / gamma) - T, 0, 10 * thrust)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("distance", [0.02, 0.05, 0.1, 0.3])
def test_below_a_ceiling_a_rotor_lifts_more(engine, distance, below_a_ceiling):
    simulation = below_a_ceiling(engine=engine)
    speed = 240
    rates = speed * np.array([1, -1, 1, -1.0])
    start(
        simulation,
        position=(0.3, 0.2, UNDERSIDE - distance - CROSS[0].xyz[2]),
        rotor_velocity=rates,
    )
    simulation.step()
    start(simulation, position=(0, 0, 0), rotor_velocity=rates)  # the plugin looked before
    found = wrenches(simulation)
    thrust = LIFT["rotorThrustCoeff"] * (2 * speed) ** 2
    expected = solve_thrust(thrust, 2 * speed, distance) - thrust
    assert found["ceiling_effect"][2] == pytest.approx(4 * expected, rel=1e-4)
    assert found["thrust"][2] == pytest.approx(4 * thrust)


def test_beside_and_above_an_obstacle_there_is_no_ceiling_effect(below_a_ceiling):
    simulation = below_a_ceiling()
    for position in ((2.5, 0, UNDERSIDE - 0.1), (0, 0, UNDERSIDE + 1.5)):
        start(simulation, position=position, rotor_velocity=[240, -240, 240, -240])
        simulation.step()
        assert not wrenches(simulation)["ceiling_effect"].any()


def test_each_rotor_has_its_own_distance_along_its_thrust(below_a_ceiling):
    simulation = below_a_ceiling(ODD)
    additions = []
    for i in range(4):
        rates = 250 * np.eye(4)[i]
        start(simulation, position=(0, 0, UNDERSIDE - 0.15), rotor_velocity=rates)
        simulation.step()
        found = wrenches(simulation)
        addition = np.linalg.norm(found["ceiling_effect"][:3])
        assert np.allclose(
            found["ceiling_effect"],
            addition / np.linalg.norm(found["thrust"][:3]) * found["thrust"],
            rtol=1e-3,  # the hinges give way
            atol=1e-12,
        )
        additions.append(addition)
    assert np.ptp(additions) > 1e-3


def test_settings_without_effect_and_without_sense_are_reported(below_a_ceiling, hangar):
    urdf = vehicle(CROSS, air=LIFT)
    with pytest.warns(qc.QuadcoreWarning, match="the world has no obstacles"):
        hangar(with_plugins(urdf, plugin("ceiling_effect", {})))
    too_large = {"advanceRatioLoss": 9}
    with pytest.raises(qc.InputError, match=r"<advanceRatioLoss> is too large"):
        hangar(with_plugins(urdf, plugin("ceiling_effect", too_large)))
