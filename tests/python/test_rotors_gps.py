"""RotorS' satellite receiver, which hangs on a sensor of Gazebo's."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from faults import refusal
from fitted import TUMBLE, X_FS, firefly_with
from scipy.spatial.transform import Rotation

import quadcore as qc

# The firefly has an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")


def noise(direction, deviation):
    return (
        f'<{direction}><noise type="gaussian"><mean>0.0</mean><stddev>{deviation}</stddev>'
        f"<bias_mean>0.0</bias_mean><bias_stddev>0.0</bias_stddev></noise></{direction}>"
    )


def receiver(place=(0, 0), velocity=(0, 0), rate=5):
    """Write one as RotorS' component_snippets.xacro does, with deviations across and along z."""
    spoiled = [noise("horizontal", d[0]) + noise("vertical", d[1]) for d in (place, velocity)]
    return (
        '<gazebo reference="mast"><sensor type="gps" name="uav_gps"><pose>0 0 0 0 0 0</pose>'
        f"<visualize>0</visualize><always_on>1</always_on><update_rate>{rate}</update_rate>"
        f"<gps><position_sensing>{spoiled[0]}</position_sensing>"
        f"<velocity_sensing>{spoiled[1]}</velocity_sensing></gps>"
        '<plugin filename="librotors_gazebo_gps_plugin.so" name="rotors_gazebo_gps_plugin">'
        "<linkName>mast</linkName><gpsTopic>gps</gpsTopic>"
        "<groundSpeedTopic>ground_speed</groundSpeedTopic>"
        f"<horPosStdDev>{place[0]}</horPosStdDev><verPosStdDev>{place[1]}</verPosStdDev>"
        f"<horVelStdDev>{velocity[0]}</horVelStdDev><verVelStdDev>{velocity[1]}</verVelStdDev>"
        "</plugin></sensor></gazebo>"
    )


def fly_tumbling(simulation, seconds):
    return simulation.run(seconds, commands=TUMBLE, topics=["gps", "ground_speed"])


def columns(message, fields):
    return np.column_stack([message[field] for field in fields])


def test_it_tells_where_on_earth_its_link_is_and_how_it_moves(tmp_path):
    simulation = firefly_with(tmp_path, receiver(), world="basic", dt=0.001)
    assert not [w for w in simulation.warnings if "<sensor>" in w]
    log = fly_tumbling(simulation, 1.1)
    sampled_rows = np.arange(0, len(log.time), 200)
    turn = Rotation.from_quat(log.orientation[sampled_rows])
    place = log.position[sampled_rows] + turn.apply(X_FS)
    velocity = log.linear_velocity[sampled_rows] + turn.apply(
        np.cross(log.angular_velocity[sampled_rows], X_FS)
    )
    fix, speed = log.topics["gps"], log.topics["ground_speed"]
    assert np.allclose(columns(fix, "xyz")[sampled_rows], place, rtol=0, atol=1e-12)
    assert np.allclose(columns(speed, "xyz")[sampled_rows], velocity, rtol=0, atol=1e-12)
    # Five times a second.
    assert np.array_equal(np.unique(fix["stamp"]).round(9), log.time[sampled_rows].round(9))
    # Metres per degree at the origin of RotorS' world.
    phi, a, e2 = math.radians(47.3667), 6378137.0, 6.69437999014e-3
    w = math.sqrt(1 - e2 * math.sin(phi) ** 2)
    north = math.pi / 180 * (a * (1 - e2) / w**3 + 500)
    east = math.pi / 180 * (a / w + 500) * math.cos(phi)
    assert np.allclose((fix["latitude"][sampled_rows] - 47.3667) * north, place[:, 1], atol=1e-7)
    assert np.allclose((fix["longitude"][sampled_rows] - 8.55) * east, place[:, 0], atol=1e-7)
    assert np.allclose(fix["altitude"][sampled_rows] - 500, place[:, 2], atol=1e-9)


def test_its_noise_has_the_deviations_of_the_sensor_and_of_the_module(tmp_path):
    noisy = receiver((3, 6), (0.1, 0.2), rate=0)
    options = {"world": "basic", "dt": 0.001}
    log = fly_tumbling(firefly_with(tmp_path, noisy, **options), 4)
    true = fly_tumbling(firefly_with(tmp_path, receiver(rate=0), **options), 4)
    for topic, deviations in (("gps", [3, 3, 6]), ("ground_speed", [0.1, 0.1, 0.2])):
        error = columns(log.topics[topic], "xyz") - columns(true.topics[topic], "xyz")
        assert error.std(axis=0) == pytest.approx(deviations, rel=0.05)
    assert log.topics["gps"]["horizontal_variance"][-1] == pytest.approx(9)
    assert log.topics["gps"]["vertical_variance"][-1] == pytest.approx(36)


WORLD = '<sdf version="1.6"><world name="w"><spherical_coordinates>{}</spherical_coordinates>'


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ("<heading_deg>30</heading_deg>", r"'rotors_gazebo_gps_plugin' .*<heading_deg>.*Write 0"),
        (
            "<latitude_deg>90</latitude_deg>",
            r"<latitude_deg> is at a pole.*Use a latitude from -89",
        ),
        (
            "\n<surface_model>MOON</surface_model>",
            r"w\.world:2: <surface_model> is 'MOON'\. Use EARTH_WGS84",
        ),
        ("\n<latitude_deg>99</latitude_deg>", r"w\.world:2: <latitude_deg> is out of range. Use"),
    ],
)
def test_a_place_on_earth_that_means_nothing_here_is_refused(tmp_path, tags, says):
    world = tmp_path / "w.world"
    world.write_text(WORLD.format(tags) + "</world></sdf>")
    message = refusal(firefly_with, tmp_path, receiver(), world=world)
    assert re.search(says, message), message


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "<mean>0.0</mean>",
            "<mean>0.3</mean>",
            "position_sensing/horizontal/noise/mean> '0.3' is",
        ),
        (
            'type="gaussian"',
            'type="none"',
            "horizontal/noise/type> 'none' is not a valid value. Use",
        ),
        ("<linkName>mast<", "<linkName>mats<", r"Did you mean 'mast'"),
        ("<update_rate>5<", "<update_rate>often<", "sensor/update_rate> 'often' is not a finite"),
    ],
)
def test_what_a_receiver_cannot_be_is_refused_with_its_line(tmp_path, old, new, says):
    message = refusal(firefly_with, tmp_path, receiver().replace(old, new, 1))
    assert re.search(r"fitted\.urdf:\d+: plugin 'rotors_gazebo_gps_plugin'", message), message
    assert re.search(says, message), message


def test_other_sensors_are_passed_over_and_a_receiver_may_be_left_out(tmp_path):
    camera = '<gazebo reference="mast"><sensor type="camera" name="eye"/></gazebo>'
    simulation = firefly_with(tmp_path, camera)
    (said,) = [w for w in simulation.warnings if "does not affect the motion" in w]
    assert re.search(r"<sensor> \(.*fitted\.urdf:\d+\)", said)
    without = firefly_with(tmp_path, receiver(), ignore=["librotors_gazebo_gps_plugin.so"])
    assert "gps" not in without.topics
    assert isinstance(without, qc.Simulation)
