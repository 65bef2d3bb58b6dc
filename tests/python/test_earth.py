"""Worlds at a place on Earth."""

import math

import numpy as np
import pytest
from processes import run_command, run_refused

import quadcore as qc
from quadcore.model.earth import Location, find_gravity, find_location, find_magnetic_field

WORLD = """<sdf version="1.5">
  <world name="w"><gravity
    >0 0
    -3</gravity>
    <!-- gravity -->
    <model name="wall"><static>1</static><link name="link"><collision name="c"><geometry>
      <box><size>1 2 3</size></box></geometry></collision></link></model>
    <spherical_coordinates>
      <latitude_deg>60</latitude_deg>
      <longitude_deg>-10.5</longitude_deg>
      <elevation>7</elevation>
    </spherical_coordinates>
    <magnetic_field>1 2 3</magnetic_field>
    <physics type="ode"><max_step_size>0.002</max_step_size></physics>
  </world>
</sdf>
"""


def test_gravity_is_that_of_the_ellipsoid():
    """WGS 84 at the equator and at the poles; 0.003086 m/s^2 less per 1000 m."""
    assert find_gravity(Location(0.0, 50.0, 0.0)) == pytest.approx(9.7803253, abs=1e-7)
    assert find_gravity(Location(-90.0, 0.0, 0.0)) == pytest.approx(9.8321849, abs=1e-7)
    assert find_gravity(Location(45.0, 0.0, 1000.0)) == pytest.approx(
        9.8061978 - 3.086e-3, abs=1e-7
    )


@pytest.mark.parametrize(
    ("location", "declination", "inclination", "strength"),
    [
        (Location(47.38, 8.54, 400.0), 3.5, 63.3, 48.4),  # Zurich
        (Location(-33.87, 151.21, 0.0), 12.8, -64.2, 57.0),  # Sydney
    ],
)
def test_the_magnetic_field_is_that_of_the_place(location, declination, inclination, strength):
    """Angles (deg) and strength (uT) as surveys state them; they drift by 0.2 deg per year."""
    east, north, up = find_magnetic_field(location) * 1e6
    level = math.hypot(east, north)
    assert math.degrees(math.atan2(east, north)) == pytest.approx(declination, abs=0.5)
    assert math.degrees(math.atan2(-up, level)) == pytest.approx(inclination, abs=0.5)
    assert math.hypot(level, up) == pytest.approx(strength, abs=0.4)


def test_a_world_gets_gravity_and_field_and_keeps_the_rest(tmp_path):
    path = tmp_path / "a.world"
    path.write_text(WORLD)
    before, place = qc.read_world(path), Location(-33.87, 151.21, 30.0)
    assert find_location(before) == Location(60.0, -10.5, 7.0)
    world = qc.read_world(path, at=place)
    assert world.gravity.tolist() == [0, 0, -find_gravity(place)]
    assert world.magnetic_field == pytest.approx(find_magnetic_field(place), rel=1e-12)
    assert find_location(world) == place and world.max_step_size == 0.002
    (wall,) = world.obstacles
    assert wall.where == before.obstacles[0].where and "a.world:7" in wall.where
    assert qc.read_world(path, at=(10, 20)).gravity[2] == -find_gravity(Location(10, 20, 0))


def test_the_command_flies_in_that_gravity(tmp_path):
    log = tmp_path / "fall.csv"
    flight = ["run", "hummingbird", "--engine", "eigen", "--duration", "0.1", "--quiet"]
    done = run_command(*flight, "--at", "47.4,8.5,400", "--log", str(log))
    assert done.returncode == 0, done.stderr
    falling = qc.Log.of_file(log).linear_velocity[-1, 2]
    assert falling == pytest.approx(-0.1 * find_gravity(Location(47.4, 8.5, 400)), rel=1e-3)
    default = qc.Simulation("hummingbird", engine="eigen").run(0.1).linear_velocity[-1, 2]
    assert falling / default == pytest.approx(
        find_gravity(Location(47.4, 8.5, 400)) / 9.8, rel=1e-5
    )


def test_a_study_flies_at_the_place():
    """The rotors of a hover turn in proportion to the square root of gravity."""

    def mean_speed(log):
        return float(np.abs(log.rotor_velocity).mean())

    speeds = []
    for latitude in (0.0, 90.0):
        found = qc.evaluate(
            *("geometric", "hover"),
            models="hummingbird",
            duration=0.1,
            at=(latitude, 0.0),
            metrics=[mean_speed],
        )
        speeds.append(found.table[0]["mean_speed"])
    ratio = find_gravity(Location(90.0, 0.0, 0.0)) / find_gravity(Location(0.0, 0.0, 0.0))
    assert speeds[1] / speeds[0] == pytest.approx(math.sqrt(ratio), rel=1e-6)


@pytest.mark.parametrize("place", ["91,3", "3,181", "nan,3"])
def test_what_is_not_on_the_earth_is_refused(place):
    refused = run_refused("run", "hummingbird", "--at", place, "--duration", "0.1")
    assert "at is " in refused or "finite" in refused


def test_a_world_that_is_read_has_its_place():
    with pytest.raises(qc.InputError, match="at: the world has already been read"):
        qc.evaluate("geometric", "hover", world=qc.read_world(), at=(0, 0), duration=0.1)
