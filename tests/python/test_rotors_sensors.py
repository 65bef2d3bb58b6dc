"""RotorS' sensors, its wind, and the way of commands through its controller's interface."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quadcore as qc

# The firefly has an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

HOVER = 543.322
TUMBLE = np.array([[0, HOVER + 8, HOVER, HOVER - 3, HOVER, HOVER + 2, HOVER - 6]])
ENGINES = [name for name, _ in qc.engines()]


def plugin(name, module, **tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    opening = f'<gazebo><plugin name="{name}" filename="librotors_gazebo_{module}.so">'
    return f"{opening}{inner}</plugin></gazebo>"


MAST = (
    '<link name="mast"><inertial><origin xyz="0.02 0 0.1"/><mass value="0.01"/>'
    '<inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial></link>'
    '<joint name="stay" type="fixed"><parent link="firefly/base_link"/><child link="mast"/>'
    '<origin xyz="0.03 -0.04 0.05" rpy="0.3 0.2 0.1"/></joint>'
)
X_FS = np.array([0.03, -0.04, 0.05])
R_FS = Rotation.from_euler("xyz", [0.3, 0.2, 0.1])


@pytest.fixture
def fitted(tmp_path):
    """A maker of fireflies that carry more."""

    def make(*parts, engine="gazebo11", spawn=(0, 0, 10), **options):
        text = qc.read_model("firefly").document.text
        path = tmp_path / "fitted.urdf"
        path.write_text(text.replace("</robot>", MAST + "".join(parts) + "</robot>"))
        return qc.Simulation(path, engine=engine, spawn=spawn, **options)

    return make


def test_speeds_for_controllers_reach_the_motors_a_step_later():
    direct, by_interface = qc.Simulation("firefly"), qc.Simulation("firefly")
    direct.step(1)
    direct.command([500] * 6)
    by_interface.publish("command_motor_speed", [500] * 6)
    for simulation in (direct, by_interface):
        simulation.step(20)
    assert direct.time == pytest.approx(by_interface.time + 0.001)
    by_interface.step(1)
    assert np.array_equal(direct.state.rotor_velocity, by_interface.state.rotor_velocity)
    # What came last counts.
    by_interface.command([300] * 6)
    by_interface.step(500)
    assert abs(by_interface.state.rotor_velocity[0]) == pytest.approx(30, abs=1e-4)
    by_interface.publish("command_motor_speed", [400] * 6)
    by_interface.step(500)
    assert abs(by_interface.state.rotor_velocity[0]) == pytest.approx(40, abs=1e-4)


def test_the_base_tells_the_speeds_before_the_motors_act():
    simulation = qc.Simulation("firefly", spawn=(0, 0, 10))
    log = simulation.run(0.1, commands=TUMBLE, topics=["motor_speed", "motor_speed_1"])
    told = log.topics["motor_speed"]
    assert np.array_equal(told["w2"][1:], 10 * log.rotor_velocity[:-1, 1])
    # The motor's own is that which it sets.
    assert np.allclose(log.topics["motor_speed_1"]["w"][1:], log.rotor_velocity[1:, 1], atol=1e-4)


def test_the_odometry_tells_of_the_centre_of_mass_and_of_the_links_origin(fitted):
    told = plugin("gauge", "odometry_plugin", linkName="mast", odometryTopic="gauge/odometry")
    simulation = fitted(told, spawn=(1, 2, 10, 0.2, -0.1, 0.5))
    log = simulation.run(1, commands=TUMBLE, topics=["gauge_odometry"])
    message = log.topics["gauge_odometry"]
    turn = Rotation.from_quat(log.orientation[:-1])
    origin = log.position[:-1] + turn.apply(X_FS)
    center = origin + (turn * R_FS).apply([0.02, 0, 0.1])
    velocity = log.linear_velocity[:-1] + turn.apply(np.cross(log.angular_velocity[:-1], X_FS))

    def rows(*fields):
        return np.array([message[f][1:] for f in fields]).T

    assert np.allclose(rows("x", "y", "z"), center, atol=1e-12)
    assert np.allclose(rows("vx", "vy", "vz"), (turn * R_FS).inv().apply(velocity), atol=1e-12)
    spin = R_FS.inv().apply(log.angular_velocity[:-1])
    assert np.allclose(rows("wx", "wy", "wz"), spin, atol=1e-12)
    between = (turn * R_FS).inv() * Rotation.from_quat(rows("qx", "qy", "qz", "qw"))
    assert between.magnitude().max() < 1e-12
    # Of a state a step before its stamp: RotorS' clock has moved on already.
    assert np.allclose(message["stamp"][1:], log.time[1:], atol=1e-12)


def test_odometry_is_measured_every_so_many_steps_and_held_back_for_some(fitted):
    prompt = plugin("prompt", "odometry_plugin", linkName="mast", odometryTopic="prompt")
    slow = plugin(
        "slow",
        "odometry_plugin",
        linkName="mast",
        odometryTopic="slow",
        measurementDivisor=4,
        measurementDelay=3,
        unknownDelay=2.7,
    )
    log = fitted(prompt, slow).run(0.1, commands=TUMBLE, topics=["prompt", "slow"])
    prompt, slow = log.topics["prompt"], log.topics["slow"]
    arrivals = np.flatnonzero(np.diff(np.nan_to_num(slow["stamp"])))
    assert np.array_equal(arrivals, np.arange(3, 100, 4))
    for row in range(4, 100, 4):
        assert slow["z"][row] == prompt["z"][row - 3]
        assert slow["stamp"][row] == pytest.approx(prompt["stamp"][row - 3] + 2)  # whole seconds


def test_noise_of_odometry_has_the_deviations_that_its_tags_give(fitted):
    told = plugin(
        "gauge",
        "odometry_plugin",
        linkName="mast",
        odometryTopic="gauge",
        noiseNormalPosition="0.1 0 0.3",
        noiseUniformLinearVelocity="0 0.6 0",
        noiseNormalQuaternion="0.02 0.02 0.02",
    )
    truth = plugin("truth", "odometry_plugin", linkName="mast", odometryTopic="truth")
    log = fitted(told, truth).run(4, topics=["gauge", "truth"])
    noisy, true = log.topics["gauge"], log.topics["truth"]

    def deviation(field):
        return (noisy[field] - true[field])[1:].std()

    assert deviation("x") == pytest.approx(0.1, rel=0.05)
    assert deviation("y") == 0
    assert deviation("z") == pytest.approx(0.3, rel=0.05)
    assert deviation("vy") == pytest.approx(0.6 / np.sqrt(3), rel=0.05)
    assert np.abs(noisy["vy"] - true["vy"])[1:].max() < 0.6
    assert noisy["position_variance"][-1] == pytest.approx(0.09)
    pairs = [np.array([m[f][1:] for f in ("qx", "qy", "qz", "qw")]).T for m in (true, noisy)]
    apart = (Rotation.from_quat(pairs[0]).inv() * Rotation.from_quat(pairs[1])).as_rotvec()
    assert apart.std(axis=0) == pytest.approx([0.02] * 3, rel=0.05)


def test_an_inertial_unit_may_take_its_noise_from_the_seed(fitted):
    def flown(seed, noise):
        unit = plugin("unit", "imu_plugin", linkName="mast", imuTopic="unit", noise=noise)
        return fitted(unit, seed=seed).run(0.05, topics=["unit"]).topics["unit"]["ax"][1:]

    assert np.array_equal(flown(1, "rotors"), flown(2, "rotors"))
    assert np.array_equal(flown(1, "seeded"), flown(1, "seeded"))
    assert not np.array_equal(flown(1, "seeded"), flown(2, "seeded"))


def test_a_unit_off_the_centre_feels_how_it_is_carried_round(fitted):
    unit = plugin(
        "unit",
        "imu_plugin",
        linkName="mast",
        imuTopic="unit",
        **{
            name + tag: 0
            for name in ("gyroscope", "accelerometer")
            for tag in ("NoiseDensity", "TurnOnBiasSigma")
        },
        accelerometerRandomWalk=0,
        gyroscopeBiasRandomWalk=0,
    )
    log = fitted(unit).run(0.5, commands=TUMBLE, topics=["unit"])
    message = log.topics["unit"]
    turn = Rotation.from_quat(log.orientation)
    v = log.linear_velocity + turn.apply(np.cross(log.angular_velocity, X_FS))
    # The velocity is that of the link's centre of mass, which lies elsewhere still.
    v += turn.apply(np.cross(log.angular_velocity, R_FS.apply([0.02, 0, 0.1])))
    a = np.diff(v, axis=0)[:-1] / 0.001 + [0, 0, 9.8]
    felt = (turn[1:-1] * R_FS).inv().apply(a)
    told = np.array([message[f][2:] for f in ("ax", "ay", "az")]).T
    assert np.allclose(told, felt, atol=1e-9)


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


def test_a_field_of_wind_from_a_file_is_refused(fitted):
    wind = plugin("wind", "wind_plugin", linkName="mast", useCustomStaticWindField="true")
    with pytest.raises(qc.InputError, match=r"fitted.urdf:\d+: plugin 'wind'.*libwind_plugin.so"):
        fitted(wind)


def test_a_sensor_on_a_link_that_turns_or_is_not_there_is_refused(fitted):
    for link, says in (
        ("firefly/rotor_0", "not part of the frame"),
        ("mats", "did you mean 'mast'"),
    ):
        unit = plugin("unit", "imu_plugin", linkName=link, imuTopic="unit")
        with pytest.raises(qc.InputError, match=says):
            fitted(unit)


def test_two_sensors_of_one_name_both_tell(fitted):
    pair = [plugin("unit", "imu_plugin", linkName="mast", imuTopic=topic) for topic in "ab"]
    simulation = fitted(*pair)
    (said,) = [w for w in simulation.warnings if "goes by" in w]
    assert "a second plugin named 'unit' (first at " in said
    assert said.endswith("goes by the name 'unit_2'")
    log = simulation.run(0.01, topics=["a", "b"])
    assert np.array_equal(log.topics["a"]["ax"][1:], log.topics["b"]["ax"][1:])  # as in RotorS


def test_the_magnetometer_turns_the_field_with_its_link(fitted):
    bias = {"noiseUniformInitialBias": "1e-6 0 2e-6", "noiseNormal": "0 3e-7 0"}
    field = plugin("field", "magnetometer_plugin", linkName="mast", magnetometerTopic="field")
    noisy = plugin("n", "magnetometer_plugin", linkName="mast", magnetometerTopic="noisy", **bias)
    log = fitted(field, noisy).run(1, commands=TUMBLE, topics=["field", "noisy"])
    turn = Rotation.from_quat(log.orientation[:-1]) * R_FS

    def told(topic):
        return turn.apply(np.array([log.topics[topic][f][1:] for f in "xyz"]).T)

    earth = [0.000021493, 0.000000815, 0.000042795]
    assert np.allclose(told("field"), earth, rtol=0, atol=1e-17)
    error = told("noisy") - earth
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
