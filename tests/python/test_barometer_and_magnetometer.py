"""libbarometer_plugin.so and libmagnetometer_plugin.so: the air's pressure, the Earth's field."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sensed import AT, RPY, make_mounted
from vehicles import start

import quadcore as qc

# Of the standard atmosphere (ISO 2533): height, m, and pressure, Pa.
STANDARD = ((-1000, 113929), (0, 101325), (1000, 89874.6), (5000, 54019.9), (11000, 22632.1))
GEOPOTENTIAL = 1 / 287.05287 * 9.80665  # K/m


def in_world(tmp_path, urdf, world, **options):
    (tmp_path / "a.urdf").write_text(urdf)
    (tmp_path / "a.world").write_text(f"<sdf><world>{world}</world></sdf>")
    return qc.Simulation(tmp_path / "a.urdf", world=tmp_path / "a.world", engine="eigen", **options)


def pressure_at(simulation, height):
    """Where the mast is, the frame being upright."""
    start(simulation, position=(3, -4, height - AT[2]))
    return simulation.topic("pressure")["pressure"]


def test_the_pressure_is_that_of_the_standard_atmosphere(hangar):
    simulation = hangar(make_mounted("barometer", {"link": "mast"}), engine="eigen")
    for height, pressure in STANDARD:
        assert pressure_at(simulation, height) == pytest.approx(pressure, rel=1e-5)


@pytest.mark.parametrize("gradient", [-0.0065, 0.004, 0])
def test_the_pressure_falls_as_the_weight_of_the_air_above(gradient, tmp_path):
    air = (
        f"<temperature>270</temperature><pressure>85000</pressure><temperature_gradient>{gradient}"
    )
    simulation = in_world(
        tmp_path,
        make_mounted("barometer", {"link": "mast"}),
        f"<atmosphere type='adiabatic'>{air}</temperature_gradient></atmosphere>",
    )
    assert pressure_at(simulation, 0) == pytest.approx(85000, rel=1e-14)
    for height in (-300, 20, 2000):
        above, below = (pressure_at(simulation, height + d) for d in (1, -1))
        # dp/dz = -rho g of a perfect gas
        slope = math.log(above / below) / 2
        temperature = 270 + gradient * height
        assert slope == pytest.approx(-GEOPOTENTIAL / temperature, rel=1e-7)


def test_where_the_air_would_be_at_absolute_zero_nothing_is_measured(hangar):
    simulation = hangar(make_mounted("barometer", {}), engine="eigen")
    with pytest.raises(qc.FlightError, match="absolute zero at this height"):
        start(simulation, position=(0, 0, 44331))


@pytest.mark.parametrize("field", [None, (2e-5, 1e-6, -4e-5)])
def test_the_field_is_the_worlds_in_the_axes_of_the_link(field, tmp_path):
    text = "" if field is None else "<magnetic_field>2e-5 1e-6 -4e-5</magnetic_field>"
    pose = (1, 2, 3, 0.3, -0.2, 2.1)
    simulation = in_world(
        tmp_path, make_mounted("magnetometer", {"link": "mast"}), text, spawn=pose
    )
    # Without an element it is that of Gazebo's worlds.
    field_W = np.array([5.5645e-6, 22.8758e-6, -42.3884e-6] if field is None else field)
    assert simulation.world.magnetic_field.tolist() == field_W.tolist()
    R_WS = Rotation.from_euler("xyz", pose[3:]) * Rotation.from_euler("xyz", RPY)
    message = simulation.topic("magnetic_field")
    expected = R_WS.inv().apply(field_W)
    assert np.allclose([message[axis] for axis in "xyz"], expected, rtol=0, atol=1e-18)
    assert message["variance"] == 0


@pytest.mark.parametrize(
    ("name", "topic", "fields", "unit"),
    [("barometer", "pressure", ["pressure"], 1), ("magnetometer", "magnetic_field", "xyz", 1e-7)],
)
def test_their_errors_have_their_deviations_and_correlation(name, topic, fields, unit, hangar):
    def errors(seconds, **tags):
        simulation = hangar(make_mounted(name, {"rate": 10, **tags}), engine="eigen", dt=0.1)
        rows = simulation.run(seconds, topics=[topic]).topics[topic]
        expected = tags.get("noise", 0) ** 2 + tags.get("drift", 0) ** 2
        assert rows["variance"][0] == pytest.approx(expected, rel=1e-15)
        found = np.column_stack([rows[field] for field in fields])
        return found - found.mean(axis=0) if "noise" in tags else found - truth

    truth = np.array([101325.0] if name == "barometer" else [5.5645e-6, 22.8758e-6, -42.3884e-6])
    noise = errors(2000, noise=2 * unit)
    assert np.allclose(noise.std(axis=0), 2 * unit, rtol=3 / math.sqrt(40000))
    assert np.abs(np.mean(noise[1:] * noise[:-1], axis=0)).max() < 4 * (2 * unit) ** 2 / 141
    T, T_c = 10000, 4
    drift = errors(T, drift=3 * unit, driftTime=T_c)
    assert np.allclose((drift**2).mean(axis=0), (3 * unit) ** 2, rtol=3 * math.sqrt(2 * T_c / T))
    for lag in (1, 40):
        correlation = np.mean(drift[lag:] * drift[:-lag], axis=0) / (drift**2).mean(axis=0)
        assert np.allclose(correlation, math.exp(-lag / 10 / T_c), rtol=0, atol=0.1)


def test_the_field_of_the_world_wins_over_that_of_its_physics(tmp_path):
    """As in Gazebo 11, whatever the order."""
    own, other = (f"<magnetic_field>{b} 0 0</magnetic_field>" for b in (1, 2))
    for world in (f"{own}<physics>{other}</physics>", f"<physics>{other}</physics>{own}"):
        simulation = in_world(tmp_path, make_mounted("imu", {}), world)
        assert simulation.world.magnetic_field.tolist() == [1, 0, 0]
