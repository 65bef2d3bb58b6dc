"""Blade flapping tilts the thrust: by hand, in chapter 2's convention."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from vehicles import (
    FLAPPING,
    HAND,
    Rotor,
    start,
    upright,
    vehicle,
    wrenches,
)

ROTOR = (Rotor((0, 0, 0)),)
FLAPPER = {**HAND, "rotorRadius": 0.1, "dragModel": "chapter2"}


def flapping(hangar, spin, v=(0, 0, 0), w=(0, 0, 0), **coefficients):
    """Force on one rotor that turns at `spin`; at 400 rad/s its thrust per speed is 4e-3 N s."""
    tags = {f"flapping{name}": value for name, value in coefficients.items()}
    found = upright(hangar, {**FLAPPER, **tags}, ROTOR, (spin,), v, w)
    return found["flapping"][:3]


@pytest.mark.parametrize("spin", [400, -400])
def test_positive_A1c_opposes_motion_whatever_way_the_rotor_turns(hangar, spin):
    force = flapping(hangar, spin, v=(3, 4, 5), A1c=0.1)
    assert np.allclose(force, [-0.012, -0.016, 0], rtol=0, atol=1e-15)


@pytest.mark.parametrize("spin", [400, -400])
def test_A1s_pushes_sideways_by_the_spin(hangar, spin):
    force = flapping(hangar, spin, v=(3, 0, 0), A1s=0.1)
    assert np.allclose(force, [0, -np.sign(spin) * 0.012, 0], rtol=0, atol=1e-15)


@pytest.mark.parametrize("spin", [400, -400])
def test_B1_and_B2_answer_to_the_rates_of_the_frame(hangar, spin):
    force = flapping(hangar, spin, w=(2, 0, 9), B1=0.05)
    assert np.allclose(force, [0, -4e-4, 0], rtol=0, atol=1e-15)
    force = flapping(hangar, spin, w=(2, 0, 9), B2=0.05)
    assert np.allclose(force, [-np.sign(spin) * 4e-4, 0, 0], rtol=0, atol=1e-15)


def test_flapping_is_the_same_in_all_directions_about_the_axis(hangar):
    simulation = hangar(vehicle(ROTOR, air={**FLAPPER, **FLAPPING}))
    v, w = np.array([3, -1, 2]), np.array([0.5, 1.5, -1])
    straight = None
    for angle in np.linspace(0, 6, 7):
        turn = Rotation.from_euler("z", angle)
        start(simulation, linear_velocity=turn.apply(v), angular_velocity=turn.apply(w))
        start(simulation, rotor_velocity=[400])
        force = turn.inv().apply(wrenches(simulation)["flapping"][:3])
        straight = force if straight is None else straight
        assert np.allclose(force, straight, rtol=0, atol=1e-15)


def test_a_rotor_at_rest_does_not_flap(hangar):
    assert not flapping(hangar, 0, v=(3, 4, 5), w=(1, 2, 3), A1c=1, A1s=1, B1=1, B2=1).any()
