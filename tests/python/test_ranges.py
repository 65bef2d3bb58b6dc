"""librange_plugin.so and liblidar_plugin.so: distances, limits, noise and messages."""

from __future__ import annotations

import math

import numpy as np
import pytest
from flights import ENGINES
from hooked import with_fixed_link, with_plugins
from vehicles import SKEW, plugin, start, vehicle

import quadcore as qc

GROUND = "<include><uri>model://ground_plane</uri></include>"
THINGS = {
    "box": ("<box><size>1 2 3</size></box>", "4 0 2 0 0 0"),
    "cylinder": ("<cylinder><radius>0.5</radius><length>4</length></cylinder>", "0 3 2 0 0 0"),
    "sphere": ("<sphere><radius>0.7</radius></sphere>", "0 -5 2 0 0 0"),
}


def make_model(name, rpy=(0, 0, 0), xyz=(0, 0, 0.1), **tags):
    urdf = vehicle((), inertia=SKEW, com=(0.01, -0.02, 0.03))
    urdf = with_fixed_link(urdf, "eye", 0.05, (1e-5, 2e-5, 2.5e-5), xyz, rpy)
    return with_plugins(urdf, plugin(name, {"link": "eye", **tags}))


@pytest.fixture
def place(tmp_path):
    """A function that returns a simulation of a model in a world."""

    def simulate(urdf, *things, spawn=(0, 0, 2), **options):
        models = "".join(
            f'<model name="{name}"><static>true</static><pose>{THINGS[name][1]}</pose>'
            f'<link name="l"><collision name="c"><geometry>{THINGS[name][0]}</geometry>'
            "</collision></link></model>"
            for name in things
            if name != "ground"
        )
        ground = GROUND if "ground" in things else ""
        (tmp_path / "it.world").write_text(f"<sdf><world>{ground}{models}</world></sdf>")
        (tmp_path / "it.urdf").write_text(urdf)
        return qc.Simulation(
            tmp_path / "it.urdf", world=tmp_path / "it.world", spawn=spawn, **options
        )

    return simulate


@pytest.mark.parametrize("engine", ENGINES)
def test_a_range_sensor_measures_the_distance_to_the_ground_along_its_beam(engine, place):
    urdf = make_model("range", rpy=(0, math.pi / 2, 0), xyz=(0.1, 0, -0.05))
    simulation = place(urdf, "ground", spawn=(5, 6, 3, 0.2, -0.3, 1), engine=engine)
    message = simulation.topic("range")
    R = simulation.state
    x, y, z, w = R.orientation
    # World z component of frame x and z axes: of the lever, and of the beam along -z.
    lever = 0.1 * 2 * (x * z - w * y) - 0.05 * (1 - 2 * (x * x + y * y))
    slope = 1 - 2 * (x * x + y * y)
    assert message["range"] == pytest.approx((3 + lever) / slope, rel=1e-12)
    assert (message["minimum"], message["maximum"]) == (0.05, 10)
    start(simulation, position=(0, 0, 30))
    assert simulation.topic("range")["range"] == math.inf
    start(simulation, position=(0, 0, 0.06))
    assert simulation.topic("range")["range"] == -math.inf


def test_a_lidar_measures_the_distance_of_each_shape(place):
    urdf = make_model("lidar", samples=4, minAngle=-math.pi / 2, maxAngle=math.pi)
    simulation = place(urdf, "ground", *THINGS)
    message = simulation.topic("scan")
    assert message["angle_min"] == -math.pi / 2
    assert message["angle_increment"] == pytest.approx(math.pi / 2)
    height = 0.1  # of the sensor above the middle of the sphere
    expected = [5 - math.sqrt(0.7**2 - height**2), 3.5, 2.5, math.inf]
    assert [message[f"r{i}"] for i in range(1, 5)] == pytest.approx(expected, rel=1e-12)
    # Turned by a quarter, each beam meets what its neighbour met.
    start(simulation, orientation=(0, 0, math.sqrt(0.5), math.sqrt(0.5)))
    message = simulation.topic("scan")
    assert [message[f"r{i}"] for i in range(1, 4)] == pytest.approx([3.5, 2.5, math.inf], rel=1e-12)


def test_a_tilted_lidar_meets_the_ground(place):
    urdf = make_model("lidar", samples=1, minAngle=0)
    simulation = place(urdf, "ground", spawn=(0, 0, 1, 0, 0.4, 0))
    expected = (1 + 0.1 * math.cos(0.4)) / math.sin(0.4)
    assert simulation.topic("scan")["r1"] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "topic", "field"), [("range", "range", "range"), ("lidar", "scan", "r2")]
)
def test_noise_has_its_deviation_and_repeats_with_its_seed(name, topic, field, place):
    tags = {"noise": 0.02, "rate": 1000, "maxRange": 20}
    tags.update({"samples": 3} if name == "lidar" else {})
    urdf = make_model(name, **tags)

    def measure(seed):
        simulation = place(urdf, "box", spawn=(0, 0, 2, 0, 0, 0), seed=seed)
        errors = []
        for _ in range(500):
            start(simulation, position=(0, 0, 1))  # it would fall
            errors.append(simulation.topic(topic)[field] - 3.5)
        return np.array(errors)

    errors = measure(1)
    assert errors.std() == pytest.approx(0.02, rel=0.15)
    assert abs(errors.mean()) < 4 * 0.02 / math.sqrt(500)
    assert measure(1).tobytes() == errors.tobytes() != measure(2).tobytes()


@pytest.mark.parametrize("limit", ["minRange", "maxRange"])
def test_a_measured_distance_beyond_a_limit_is_infinite(limit, place):
    urdf = make_model("range", noise=0.02, rate=1000, **{limit: 3.5})
    simulation = place(urdf, "box", spawn=(0, 0, 2, 0, 0, 0))
    measured = []
    for _ in range(200):
        start(simulation, position=(0, 0, 1))
        measured.append(simulation.topic("range")["range"])
    measured = np.array(measured)
    finite = measured[np.isfinite(measured)]
    beyond = -math.inf if limit == "minRange" else math.inf
    assert 50 < len(finite) < 150 and set(measured[~np.isfinite(measured)]) == {beyond}
    assert (finite >= 3.5).all() if limit == "minRange" else (finite <= 3.5).all()


def test_a_log_contains_the_distances_and_reads_them_back(place, tmp_path):
    urdf = make_model("lidar", samples=2, minAngle=0, maxAngle=math.pi, rate=100)
    log = place(urdf, "box").run(0.05, topics=["scan"])
    assert log.topics["scan"]["r1"][-1] == pytest.approx(3.5)
    for suffix in (".csv", ".mat"):
        log.to_file(tmp_path / f"log{suffix}")
        again = qc.Log.of_file(tmp_path / f"log{suffix}").topics["scan"]["r2"]
        assert np.isposinf(again).all()


@pytest.mark.parametrize(
    ("name", "tags", "says"),
    [
        ("range", {"minRange": 3, "maxRange": 2}, r"<minRange> is not below <maxRange>\. Write"),
        ("lidar", {"samples": 2.5}, r"<samples> is not a whole number\. Write"),
        ("lidar", {"minAngle": 1, "maxAngle": 0}, r"<maxAngle> is below <minAngle>\. Exchange"),
    ],
)
def test_settings_that_make_no_sense_are_refused(name, tags, says, place):
    with pytest.raises(qc.InputError, match=says):
        place(make_model(name, **tags))
