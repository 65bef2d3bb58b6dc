"""The picture of a vehicle shows what the model says."""

from __future__ import annotations

import numpy as np
import pytest
from vehicles import AIR, COM, MOTOR, ODD, SKEW, vehicle

import quadcore as qc
from quadcore.cli import main
from quadcore.report import vehicle_plot


@pytest.fixture
def odd(hangar):
    return hangar(vehicle(ODD, inertia=SKEW, com=COM, air=AIR, motor=MOTOR), gravity=(0, 0, -9.8))


def test_a_box_has_the_mass_the_place_and_the_inertia_of_its_link(odd):
    for link, pose in zip(odd.model.links, odd.model.link_poses):
        corners = vehicle_plot._box(link, pose)
        assert np.allclose(corners.mean(axis=0), pose[:3, :3] @ link.center_of_mass + pose[:3, 3])
        # Of a solid box the second moments are a third of those of masses at its corners.
        arms = corners - corners.mean(axis=0)
        second = link.mass * (arms.T @ arms) / 8 / 3
        inertia = np.trace(second) * np.eye(3) - second
        assert np.allclose(inertia, pose[:3, :3] @ link.inertia @ pose[:3, :3].T, rtol=1e-9)


def spins(simulation):
    """Of each rotor, whether it turns counter-clockwise seen from above."""
    rotors = vehicle_plot._rotors(simulation)
    return [rotor.colour == vehicle_plot._AHEAD for rotor in rotors]


def test_rotors_turn_as_in_hover_whatever_sign_their_commands_have():
    quadrotor, firefly = (qc.Simulation(name) for name in ("quadrotor", "firefly"))
    assert spins(quadrotor) == [True, False, True, False]
    assert np.all(np.sign(quadrotor.hover_speed) == [1, -1, 1, -1])
    assert sum(spins(firefly)) == 3
    assert np.all(firefly.hover_speed > 0)


def test_a_vehicle_that_nothing_drives_is_drawn_with_rotors_at_rest(hangar):
    still = hangar(vehicle(ODD))
    assert [rotor.colour for rotor in vehicle_plot._rotors(still)] == [vehicle_plot._STILL] * 4
    vehicle_plot.draw(still)


def test_info_writes_the_picture_and_refuses_other_files(tmp_path, capsys):
    for name in ("a.png", "b.png"):
        assert main(["info", "quadrotor", "--picture", str(tmp_path / name)]) == 0
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert main(["info", "quadrotor", "--picture", "a.svg"]) == 2
    assert "Name a file that ends in .png" in capsys.readouterr().err
