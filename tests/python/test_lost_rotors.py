"""Vehicles that lose a rotor: allocation with and without detection."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from hooked import with_plugins
from vehicles import plugin

import quadcore as qc
from quadcore.cli import main
from quadcore.support.rotation import to_roll_pitch_yaw

ALTERNATING = (1, -1, 1, -1, 1, -1)
PAIRED = (1, 1, -1, -1, 1, -1)  # two neighbours of one sense, twice
LOST_AT = 2.0  # s


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def scenario(rotor, detection=0.0, event="weaken: {}, to: 0"):
    setting = "" if detection is None else f"detection: {detection}"
    text = (
        f"plugins: {{fault: {{{setting}}}}}\nevents: [{{at: {LOST_AT}, {event.format(rotor)}}}]\n"
    )
    Path("lost.yaml").write_text(text)
    return "lost.yaml"


def fly_and_lose(rotor, spins, engine="eigen", detection=0.0, event="weaken: {}, to: 0", **options):
    """Log, distance and yaw over time of a flight in which a rotor is lost."""
    controller = qc.controllers.parse(options.pop("controller", "geometric"), "hexarotor")
    controller.spins = list(spins)
    usual = {
        "reference": qc.references.parse("hover"),
        "duration": 12.0,
        "xacro_args": {"sim_slow": 1},
    }
    plan = qc.FlightPlan.of(
        "hexarotor",
        scenario=scenario(rotor, detection, event),
        engine=engine,
        controller=controller,
        on_reference=True,
        log_every=10,
        **{**usual, **options},
    )
    log = plan.fly()
    error = log.topics["error"]
    distance = np.sqrt(sum(error[axis] ** 2 for axis in "xyz"))
    return log, distance, np.unwrap(to_roll_pitch_yaw(log.orientation)[:, 2])


@pytest.mark.parametrize("rotor", range(1, 7))
@pytest.mark.parametrize("spins", [ALTERNATING, PAIRED], ids=["PNPNPN", "PPNNPN"])
def test_a_hexarotor_with_a_detected_lost_rotor_holds_its_position(spins, rotor):
    _, distance, yaw = fly_and_lose(rotor, spins)
    assert distance.max() < 0.5
    assert distance[-1] < 0.05
    if spins == PAIRED and rotor <= 4:
        assert np.abs(yaw).max() < 0.2 and abs(yaw[-1]) < 0.01
    else:
        assert np.abs(yaw).max() > 0.2  # as it must


@pytest.mark.parametrize(("spins", "rotor"), [(ALTERNATING, 2), (PAIRED, 3)])
def test_it_does_so_in_gazebos_engine_too(spins, rotor):
    _, distance, yaw = fly_and_lose(rotor, spins, "gazebo11")
    assert distance.max() < 0.5
    assert spins == ALTERNATING or np.abs(yaw).max() < 0.2


def test_a_late_detection_is_worse_and_no_detection_worse_still():
    """The flights are the same until somebody knows."""
    logs, away = {}, {}
    for detection in (0.0, 0.2, None):
        logs[detection], distance, _ = fly_and_lose(2, PAIRED, detection=detection, duration=6.0)
        away[detection] = distance.max()
    assert away[0.0] < 0.01 < away[0.2] < 0.3 < away[None]
    table, time = {key: log.table for key, log in logs.items()}, logs[0.0].time
    assert table[0.2][time < 2.2].tobytes() == table[None][time < 2.2].tobytes()
    assert table[0.0][time < 2.0].tobytes() == table[None][time < 2.0].tobytes()
    assert not np.array_equal(table[0.2][time < 2.25], table[None][time < 2.25])


def test_a_rotor_that_is_cut_and_slows_down_in_the_air_is_lost_as_well():
    log, distance, yaw = fly_and_lose(
        3,
        PAIRED,
        event="cut: {}",
        xacro_args={"sim_slow": 1, "motor": "first_order"},
        parameters={"drone_plugin.reactionOn": "rotor"},
        duration=15.0,
    )
    since = distance[log.time > LOST_AT]
    assert since.max() < 0.5 and since[-1] < 0.05
    assert abs(yaw[-1]) < 0.01
    assert abs(log.rotor_velocity[-1, 2]) < 30


@pytest.mark.parametrize("controller", ["geometric", "indi", "lqr"])
@pytest.mark.parametrize("reference", ["circle", "eight"])
def test_it_goes_on_along_a_path(controller, reference):
    _, distance, _ = fly_and_lose(
        1,
        ALTERNATING,
        controller=controller,
        detection=0.05,
        reference=qc.references.parse(reference),
    )
    assert distance.max() < 0.5


def write_guided_urdf(*plugins):
    text = qc.read_model("hexarotor", {"sim_slow": "1"}).document.text
    Path("guided.urdf").write_text(with_plugins(text, *plugins))
    return "guided.urdf"


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_the_plugin_and_the_controller_from_python_detect_faults_alike(engine):
    fault = plugin("fault", {"losses": "0.3 2 0  0.7 4 0.8", "detection": 0.1})
    spins = " ".join(map(str, PAIRED))
    controller = plugin("controller", {"law": "geometric", "spins": spins})
    plugged = qc.Simulation(
        write_guided_urdf(fault, controller, plugin("reference", {"shape": "hover"})), engine=engine
    )
    called = qc.Simulation(write_guided_urdf(fault), engine=engine)
    shape = qc.references.parse("hover")
    for simulation in (plugged, called):
        simulation.set_state(qc.references.start(simulation, shape, PAIRED))
    one = plugged.run(1.2, topics=["health"])
    geometric = qc.controllers.geometric(spins=PAIRED)
    other = called.run(1.2, controller=geometric, reference=shape)
    assert one.table.tobytes() == other.table.tobytes()
    health, time = one.topics["health"], one.time
    for name, at, left in (("s2", 0.4, 0.0), ("s4", 0.8, 0.8)):
        assert (health[name][(time > 0.01) & (time <= at)] == 1).all()
        assert (health[name][time > at + 0.0011] == left).all()
    assert (health["s3"][1:] == 1).all()


def test_somebody_else_may_find_out():
    controller = plugin("controller", {"law": "geometric", "spins": " ".join(map(str, PAIRED))})
    plugged = qc.Simulation(
        write_guided_urdf(controller, plugin("reference", {"shape": "hover"})), engine="eigen"
    )
    plugged.set_state(qc.references.start(plugged, qc.references.hover(), PAIRED))
    plugged.publish("effectiveness", [1, 0, 1, 1, 1, 1])
    plugged.publish("health", [1, 0, 1, 1, 1, 1])
    assert plugged.run(3.0).rotor_velocity[-1, 1] == pytest.approx(0, abs=1)
    plugged.publish("health", [1, 2, 1, 1, 1, 1])
    with pytest.raises(qc.FlightError, match="topic 'health': s2 is out of range"):
        plugged.step()


@pytest.mark.parametrize("detection", [None, 0.0])
def test_a_quadrotor_that_loses_a_rotor_is_reported_lost_with_time_and_place(detection):
    command = ["evaluate", "--controller", "geometric", "--reference", "hover"]
    command += ["--xacro", "sim_slow:=1", "--duration", "6", "--engine", "eigen,gazebo11"]
    command += ["--scenario", scenario(3, detection), "--no-plots", "--quiet", "--out", "out"]
    assert main(command) == 3
    with open("out/table.csv") as stream:
        failures = [row["failure"] for row in csv.DictReader(stream)]
    assert len(failures) == 2
    for failure in failures:
        number = r"(-?[\d.]+)"
        found = re.fullmatch(
            rf"lost at t = {number} s, x = {number} m, y = {number} m, z = {number} m", failure
        )
        assert found, failure
        time, *place = map(float, found.groups())
        assert LOST_AT < time < 5
        assert np.linalg.norm(np.subtract(place, [0, 0, 10])) == pytest.approx(5, abs=0.1)
