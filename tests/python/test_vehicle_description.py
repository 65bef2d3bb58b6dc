"""Description of its vehicle that a plugin receives."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import (
    CARGO,
    CHAPTER2,
    G,
    assert_same_bytes,
    with_plugins,
)
from scipy.spatial.transform import Rotation
from vehicles import AIR, CROSS, LIFT, MOTOR, ODD, ROUND, SKEW, plugin, vehicle

import quadcore as qc

pytestmark = pytest.mark.usefixtures("hook_plugins")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("drag_model", ["chapter2", "appendix"])
@pytest.mark.parametrize("reaction", ["thesis", "opposing"])
def test_a_plugin_reads_the_description_of_its_vehicle(engine, drag_model, reaction, hangar):
    air = {**CHAPTER2, "dragModel": drag_model, "reactionTorque": reaction, "sim_slow": 2}
    urdf = vehicle(ODD, inertia=SKEW, com=(0.01, -0.02, 0.03), air=air)
    urdf = with_plugins(urdf, plugin("cargo", CARGO))
    place = {"wind": (1, 2, 3), "spawn": (0, 0, 1, 0.5, 0.4, 0.3), "engine": engine}
    simulation = hangar(with_plugins(urdf, plugin("probe", {})), G, **place)
    description = simulation.topic("vehicle")
    assert description["mass"] == pytest.approx(simulation.mass, rel=1e-15)
    c = [description[name] for name in ("cx", "cy", "cz")]
    assert np.allclose(c, simulation.center_of_mass, rtol=0, atol=1e-16)
    assert description["g"] == -9.8
    k, b = (4 * LIFT[tag] for tag in ("rotorThrustCoeff", "rotorTorqueCoeff"))
    for i, rotor in enumerate(ODD, 1):
        axis = Rotation.from_euler("xyz", rotor.rpy).apply([0, 0, 1])
        assert description[f"m{i}"] == pytest.approx(rotor.inertia[2], rel=1e-5)
        for name, expected in (("p", rotor.xyz), ("o", rotor.xyz), ("a", axis)):
            assert np.allclose(
                [description[name + x + str(i)] for x in "xyz"], expected, rtol=0, atol=1e-5
            )
        for sense, sign in (("p", 1), ("n", -1)):
            force = k * axis
            about = np.array([0, 0, 1]) if drag_model == "appendix" else axis
            torque = np.cross(np.array(rotor.xyz) - c, force)
            torque = torque + (1 if reaction == "thesis" else -1) * sign * b * about
            wrench = [description[n + x + sense + str(i)] for n in "ft" for x in "xyz"]
            assert np.allclose(wrench, [*force, *torque], rtol=0, atol=1e-5 * k)
    without = hangar(urdf, G, **place)
    assert_same_bytes(simulation.run(0.1), without.run(0.1), "cube")  # nothing of it was flown


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("mass", [0.8, 1.7])
def test_a_plugin_that_knows_what_it_flies_hovers(engine, mass, hangar):
    urdf = vehicle(CROSS, mass=mass, inertia=ROUND, com=(0, 0, 0), air=AIR, motor=MOTOR)
    simulation = hangar(with_plugins(urdf, plugin("hover", {})), G, engine=engine)
    simulation.step(3000)
    sinking = simulation.state.linear_velocity[2]
    simulation.step(1000)
    assert simulation.state.linear_velocity[2] == pytest.approx(sinking, abs=1e-5)


def test_a_plugin_that_cannot_be_prepared_is_named(hangar):
    with pytest.raises(qc.InputError, match=r"plugin 'hover' .*libhover.* lift nothing; add their"):
        hangar(with_plugins(vehicle(CROSS, motor=MOTOR), plugin("hover", {})), G)
