"""RotorS' wind, field and pressure, and what is odd about where its sensors sit."""

from __future__ import annotations

import numpy as np
import pytest
from fitted import R_FS, TUMBLE, X_FS, plugin
from scipy.spatial.transform import Rotation

import quadcore as qc

# The firefly has an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

ENGINES = [name for name, _ in qc.engines()]
GUST = {"windGustForceMean": 2, "windGustStart": 0.1, "windGustDuration": 0.05}


@pytest.mark.parametrize("engine", ENGINES)
def test_wind_is_a_force_at_a_point_and_a_gust_that_ends(fitted, engine):
    wind = plugin(
        "wind",
        "wind_plugin",
        linkName="mast",
        xyzOffset="0 0 0.1",
        windForceMean=0.5,
        windDirection="0 3 0",
        windGustDirection="1 0 0",
        **GUST,
    )
    simulation = fitted(wind, engine=engine)
    log = simulation.run(0.3, wrenches=True)
    force = log.wrenches["wind_force"]
    turn = Rotation.from_quat(log.orientation)
    world = turn.apply(force[:, :3])
    # The gust acts in the steps after which the clock stands within it.
    steps = np.rint(log.time / 0.001).astype(int)
    gusty = (steps >= 100) & (steps < 150)  # rows show what acted in the step that ends there
    assert np.allclose(world[1:, 1], 0.5, atol=1e-12)
    assert np.allclose(world[1:, 0], np.where(gusty[1:], 2, 0), atol=1e-12)
    arm = X_FS + R_FS.apply([0.02, 0, 0.2]) - center_of(simulation)
    assert np.allclose(force[:, 3:], np.cross(arm, force[:, :3]), atol=1e-6)


def center_of(simulation):
    links = simulation.model.links
    mass = sum(link.mass for link in links)
    frame = links[0].mass * np.array(links[0].center_of_mass)
    rotors = sum(
        link.mass * (np.array(joint.xyz) + link.center_of_mass)
        for link, joint in zip(links[1:], simulation.model.joints)
    )
    return (frame + rotors) / mass


@pytest.mark.parametrize("engine", ENGINES)
def test_wind_that_blows_is_felt_by_the_rotors_drag_alone(fitted, engine):
    wind = plugin("wind", "wind_plugin", linkName="mast", windSpeedMean=3, windDirection="1 0 0")
    simulation = fitted(wind, engine=engine)
    state = simulation.state.copy()
    state.rotor_velocity = 54 * np.array([1, -1, 1, -1, 1, -1])
    simulation.set_state(state)
    log = simulation.run(0.001, wrenches=True)
    drag = log.wrenches["rotor_drag"][0]
    assert drag[0] == pytest.approx(6 * 540 * 8.06428e-05 * 3, rel=1e-9)
    assert np.allclose(drag[1:3], 0, atol=1e-12)
    assert np.allclose(log.wrenches["wind_force"], 0)


def test_a_sensor_on_a_link_that_turns_or_is_not_there_is_refused(fitted):
    for link, says in (
        ("firefly/rotor_0", "not part of the frame"),
        ("mats", "Did you mean 'mast'"),
    ):
        unit = plugin("unit", "imu_plugin", linkName=link, imuTopic="unit")
        with pytest.raises(qc.InputError, match=says):
            fitted(unit)


def test_two_sensors_of_one_name_both_tell(fitted):
    pair = [plugin("unit", "imu_plugin", linkName="mast", imuTopic=topic) for topic in "ab"]
    simulation = fitted(*pair)
    (said,) = [w for w in simulation.warnings if "It is renamed" in w]
    assert "a second plugin is named 'unit' (first at " in said
    assert said.endswith("It is renamed 'unit_2'.")
    log = simulation.run(0.01, topics=["a", "b"])
    assert np.array_equal(log.topics["a"]["ax"][1:], log.topics["b"]["ax"][1:])  # as in RotorS


def test_the_magnetometer_turns_the_field_with_its_link(fitted):
    bias = {"noiseUniformInitialBias": "1e-6 0 2e-6", "noiseNormal": "0 3e-7 0"}
    field = plugin("field", "magnetometer_plugin", linkName="mast", magnetometerTopic="field")
    noisy = plugin("n", "magnetometer_plugin", linkName="mast", magnetometerTopic="noisy", **bias)
    log = fitted(field, noisy).run(1, commands=TUMBLE, topics=["field", "noisy"])
    turn = Rotation.from_quat(log.orientation[:-1]) * R_FS

    def read_topic(topic):
        return turn.apply(np.array([log.topics[topic][f][1:] for f in "xyz"]).T)

    earth = [0.000021493, 0.000000815, 0.000042795]
    assert np.allclose(read_topic("field"), earth, rtol=0, atol=1e-17)
    error = read_topic("noisy") - earth
    assert np.ptp(error[:, [0, 2]], axis=0).max() < 1e-17
    assert 0 < np.abs(error[0, 0]) < 1e-6
    assert 0 < np.abs(error[0, 2]) < 2e-6
    assert error[:, 1].std() == pytest.approx(3e-7, rel=0.1)


def test_the_pressure_is_that_of_the_standard_atmosphere(fitted):
    sea = plugin(
        "sea", "pressure_plugin", linkName="mast", referenceAltitude=0, pressureTopic="sea"
    )
    high = plugin("high", "pressure_plugin", linkName="mast", pressureTopic="high")
    noisy = plugin("n", "pressure_plugin", linkName="mast", pressureTopic="n", pressureVariance=25)
    topics = ["sea", "high", "n"]
    log = fitted(sea, high, noisy, spawn=(0, 0, 0)).run(1, topics=topics)
    assert log.topics["sea"]["pressure"][1] == pytest.approx(101325, rel=1e-12)
    # Of the tables: 95461 Pa at a geometric height of 500 m.
    assert log.topics["high"]["pressure"][1] == pytest.approx(95461, abs=1)
    error = log.topics["n"]["pressure"] - log.topics["high"]["pressure"]
    assert error[1:].std() == pytest.approx(5, rel=0.1)
    assert log.topics["n"]["variance"][-1] == 25


def test_topics_tell_what_a_namespace_has_beyond_the_vehicles_own(fitted):
    space = "<robotNamespace>uav{}</robotNamespace>"
    own = plugin("own", "imu_plugin", linkName="mast", imuTopic="sense", robotNamespace="uav")
    camera = own.replace("own", "camera").replace(space.format(""), space.format("/vi_sensor"))
    assert {"sense", "vi_sensor_sense"} <= set(fitted(own, camera).topics)


def test_a_tag_that_a_fork_has_added_to_a_sensor_is_refused_with_the_option_that_leaves_it_out(
    fitted,
):
    forked = plugin("unit", "imu_plugin", linkName="mast", imuTopic="unit", measurementDivisor=3)
    says = r"unknown tag <measurementDivisor>.*--ignore librotors_gazebo_imu_plugin\.so"
    with pytest.raises(qc.InputError, match=says):
        fitted(forked)


def test_a_second_wind_is_refused_with_its_line_and_a_remedy(fitted):
    winds = [plugin(name, "wind_plugin", linkName="mast") for name in ("wind", "more_wind")]
    with pytest.raises(qc.InputError, match=r":\d+: plugin 'wind' .*Load only one"):
        fitted(*winds)


def test_a_wind_tells_how_it_blows(fitted):
    wind = plugin(
        "wind", "wind_plugin", linkName="mast", windSpeedMean=3, windDirection="0 2 0", **GUST
    )
    log = fitted(wind).run(0.2, topics=["wind_speed", "external_force"])
    assert log.topics["wind_speed"]["y"][1:] == pytest.approx(3)
    pushes = log.topics["external_force"]["fy"][1:]
    assert np.count_nonzero(pushes == 2) == 50 and np.count_nonzero(pushes) == 50


def test_flags_are_read_as_xacro_writes_them(fitted):
    """RotorS' own macro hands a flag to ${...}, which makes it Python's."""
    wind = plugin("wind", "wind_plugin", linkName="mast", useCustomStaticWindField="False")
    assert "wind_speed" in fitted(wind).topics
