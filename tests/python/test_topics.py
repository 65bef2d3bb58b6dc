"""Topics: kinds, one writer, the order of the plugins, what Python publishes, what a log keeps."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from faults import refusal
from flights import ENGINES, MANOEUVRE, quadrotor
from relays import FIRST, element, odometry

from quadcore.cli import main

ODOM = ["x", "y", "z", "qx", "qy", "qz", "qw", "vx", "vy", "vz", "wx", "wy", "wz"] + [
    f"{what}_variance"
    for what in ("position", "orientation", "linear_velocity", "angular_velocity")
]


def test_a_simulation_tells_its_topics():
    topics = quadrotor().topics
    assert list(topics) == ["effectiveness", "vel_cmd", "power", "saturation", "odom"]
    odom, commands, saturation = topics["odom"], topics["vel_cmd"], topics["saturation"]
    assert (odom.name, odom.kind, odom.fields) == ("odom", "odometry", ODOM)
    assert (odom.writer, odom.readers) == ("odometry", [])
    assert (commands.kind, commands.fields) == ("speeds", ["w1", "w2", "w3", "w4"])
    assert (commands.writer, commands.readers) == (None, ["motorpid_plugin"])
    assert (saturation.kind, saturation.fields) == ("saturation", ["steps"])
    assert (saturation.writer, saturation.readers) == ("motorpid_plugin", [])
    for name, reader in (("effectiveness", "drone_plugin"), ("power", "motorpid_plugin")):
        shares = topics[name]
        assert (shares.kind, shares.fields) == ("shares", ["s1", "s2", "s3", "s4"])
        assert (shares.writer, shares.readers) == (None, [reader])


def test_a_command_is_a_message_on_vel_cmd():
    flown = []
    for give in (
        lambda s, w: s.command(w),
        lambda s, w: s.publish("vel_cmd", w),
        lambda s, w: s.publish("vel_cmd", {f"w{i + 1}": w[i] for i in (2, 0, 3, 1)}),
    ):
        simulation = quadrotor()
        simulation.step(3)
        give(simulation, [480, -475, 485, -470])
        message = simulation.topic("vel_cmd")
        assert (message["stamp"], message["count"], message["w2"]) == (0.003, 1, -475)
        flown.append(simulation.run(0.1).table.tobytes())
    assert flown[0] == flown[1] == flown[2]


@pytest.mark.parametrize(
    ("topic", "values", "says"),
    [
        ("vel_cmb", [1], "topic 'vel_cmb' does not exist. Did you mean 'vel_cmd'?"),
        ("rain", {"x": 1}, "topic 'rain' does not exist. Choose one of effect"),
        (
            "vel_cmd",
            [1, 2],
            "publish: topic 'vel_cmd': 2 numbers are given. Give 4: w1, w2, w3, w4.",
        ),
        ("vel_cmd", [1, 2, np.nan, 4], "publish: topic 'vel_cmd': w3 is not a finite number"),
        ("vel_cmd", "fast", "publish: topic 'vel_cmd' is not a 1-dimensional array of numbers"),
        ("vel_cmd", {"w1": 1, "w5": 2}, "topic 'vel_cmd': fields w1, w5. Give w1, w2, w3, w4"),
    ],
)
def test_a_message_that_cannot_be_is_refused_and_changes_nothing(topic, values, says):
    simulation = quadrotor()
    assert says in refusal(simulation.publish, topic, values)
    assert simulation.topic("vel_cmd")["count"] == 0


def test_publishing_on_the_topic_of_a_plugin_is_reported(relays):
    simulation = relays(element("out", publishes="push"))
    assert refusal(simulation.publish, "push", [1, 2]) == (
        f"publish() writes topic 'push', which toy.urdf:{FIRST}: plugin 'out' already writes. "
        "Keep one of the two."
    )


@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_published_reaches_its_plugin_in_the_next_step(relays, engine):
    pushed = relays(element("in", takes="push", publishes="echo", gain=2), engine=engine)
    left = relays(element("in", takes="push", publishes="echo", gain=2), engine=engine)
    for simulation in (pushed, left):
        simulation.step(5)
    pushed.publish("push", {"b": 4, "a": 3})
    for simulation in (pushed, left):
        simulation.step()
    echo = pushed.topic("echo")
    assert (echo["a"], echo["b"], echo["stamp"]) == (6.005, 8.005, 0.005)
    assert pushed.state.rotor_velocity[0] != left.state.rotor_velocity[0]


@pytest.mark.parametrize("engine", ENGINES)
def test_plugins_in_every_order_fly_the_same(relays, engine):
    chain = [
        element("b", takes="one", publishes="two", gain=-2),
        element("a", takes="two", publishes="three", gain=0.5),
        element("c", publishes="one"),
        odometry("second", topic="other", positionNoise=0.1),
    ]
    flown = set()
    for elements in itertools.permutations(chain):
        simulation = relays(*elements, engine=engine)
        log = simulation.run(0.02, topics=["three", "other", "odom"])
        every = [column for name in log.topics for column in log.topics[name].values()]
        flown.add(log.table.tobytes() + np.array(every).tobytes())
    assert len(flown) == 1
    # One hand after the other within a sample: a = 0.5 (-2 t + t) + t.
    assert np.array_equal(log.topics["three"]["a"][1:], 0.5 * log.topics["three"]["stamp"][1:])


def test_a_loop_of_topics_is_refused_by_name_unless_one_is_read_late(relays):
    ahead = element("ahead", takes="back", publishes="forth")
    behind = element("behind", takes="forth", publishes="back", gain=3)
    late = ahead.replace("<takes>", "<late>true</late><takes>")
    message = refusal(relays, ahead, behind)
    assert f"toy.urdf:{FIRST}: plugin 'ahead' reads topic 'back' from 'behind'" in message
    assert f"toy.urdf:{FIRST + 1}: plugin 'behind' reads topic 'forth' from 'ahead'" in message
    for elements in ((late, behind), (behind, late)):
        log = relays(*elements).run(0.005, topics=["forth", "back"])
        forth, back = log.topics["forth"]["a"], log.topics["back"]["a"]
        stamp = log.topics["forth"]["stamp"]
        assert np.array_equal(back[1:], 3 * forth[1:] + stamp[1:])
        assert np.array_equal(forth[2:], back[1:-1] + stamp[2:])


@pytest.mark.parametrize("reader", ["a", "z"])  # by name before and after the writer
def test_a_topic_taken_late_is_a_sample_late_wherever_plugins_stand(relays, reader):
    writer = element("m", publishes="clock")
    late = element(reader, takes="clock", publishes="late", late="true", gain=2)
    for elements in ((writer, late), (late, writer)):
        log = relays(*elements).run(0.005, topics=["clock", "late"])
        clock, sum_of_both = log.topics["clock"]["a"], log.topics["late"]["a"]
        assert np.array_equal(sum_of_both[2:], 2 * clock[1:-1] + clock[2:])


def test_two_that_write_one_topic_are_refused_by_name(relays):
    twice = [element("one", publishes="push"), element("two", publishes="push")]
    assert refusal(relays, *twice) == (
        f"toy.urdf:{FIRST + 1}: plugin 'two' writes topic 'push', which toy.urdf:{FIRST}: plugin "
        "'one' already writes. Keep one of the two."
    )


def test_two_that_mean_different_kinds_are_refused_by_name(relays):
    message = refusal(relays, element("one", publishes="odometer"), element("two", takes="odom"))
    assert (
        f"toy.urdf:{FIRST + 1}: plugin 'two' declares topic 'odom' as 'relay' (a, b), but"
        in message
    )
    assert message.endswith(". Make the declarations agree.")


def test_a_name_that_no_log_could_carry_is_refused(relays):
    message = refusal(relays, element("one", publishes="/push"))
    assert message.startswith(f"toy.urdf:{FIRST}: plugin 'one' ")
    assert message.endswith(
        "topic '/push' is not a valid name. Start with a letter and use only letters, digits and _."
    )


def test_a_second_odometry_publishes_on_its_own_topic(relays):
    both = relays(odometry("second", topic="noisy", positionNoise=0.1, rate=50), seed=3)
    alone = relays(seed=3)
    for simulation in (both, alone):
        simulation.step(100)
    assert both.topic("odom") == alone.topic("odom")
    noisy, true = both.topic("noisy"), both.topic("odom")
    assert noisy["count"] == 6 and true["count"] == 11
    assert noisy["x"] != true["x"] and noisy["vz"] == true["vz"]
    assert noisy["position_variance"] == 0.1**2
    assert both.topics["noisy"].writer == "second"


@pytest.mark.parametrize("engine", ENGINES)
def test_a_restored_flight_has_its_topics_back(relays, engine):
    elements = (
        element("out", takes="back", publishes="forth", late="true"),
        element("in", takes="forth", publishes="back"),
        element("apart", takes="push", publishes="echo"),
    )
    simulation = relays(*elements, engine=engine)
    simulation.publish("push", [5, 6])
    simulation.step(7)
    snapshot = simulation.snapshot()
    names = list(simulation.topics)
    flown = simulation.run(0.02, topics=names)
    simulation.publish("push", [7, 8])
    simulation.step(3)
    simulation.restore(snapshot)
    again = simulation.run(0.02, topics=names)
    for name in names:
        for field, values in flown.topics[name].items():
            assert np.array_equal(values, again.topics[name][field], equal_nan=True)
    assert flown.table.tobytes() == again.table.tobytes()


@pytest.fixture(scope="module")
def log_topics():
    return quadrotor().run(0.1, MANOEUVRE, log_every=10, topics=["odom", "vel_cmd"])


def test_a_log_keeps_what_a_topic_said(log_topics):
    simulation = quadrotor()
    assert list(log_topics.topics) == ["odom", "vel_cmd"]
    assert list(log_topics.topics["odom"]) == ["stamp", *ODOM]
    for row in range(len(log_topics)):
        message = simulation.topic("odom")
        for field, values in log_topics.topics["odom"].items():
            assert values[row] == message[field]
        simulation.run(0.01, MANOEUVRE)
    first = log_topics.topics["vel_cmd"]
    assert np.isnan([values[0] for values in first.values()]).all()
    assert first["w2"][-1] == -475 and first["stamp"][-1] == 0.099
    assert np.array_equal(log_topics.table, quadrotor().run(0.1, MANOEUVRE, log_every=10).table)


def test_csv_and_mat_hold_the_topics_behind_the_state(log_topics, tmp_path):
    log_topics.to_csv(tmp_path / "log.csv")
    head, *rows = (tmp_path / "log.csv").read_text().splitlines()
    names = [f"odom.{f}" for f in ("stamp", *ODOM)] + [
        f"vel_cmd.{f}" for f in ("stamp", "w1", "w2", "w3", "w4")
    ]
    assert head.split(",") == [*log_topics.columns, *names]
    read = np.genfromtxt(rows, delimiter=",")
    assert np.array_equal(read[:, : len(log_topics.columns)], log_topics.table)
    assert np.array_equal(
        read[:, head.split(",").index("odom.vz")], log_topics.topics["odom"]["vz"]
    )
    log_topics.to_mat(tmp_path / "log.mat")
    variables = scipy.io.loadmat(tmp_path / "log.mat", simplify_cells=True)
    for field, values in log_topics.topics["odom"].items():
        assert np.array_equal(variables["topic_odom"][field], values)
    assert np.array_equal(variables["z"], log_topics.position[:, 2])


def test_the_command_line_logs_topics_as_python_does(log_topics, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.savetxt("fly.csv", MANOEUVRE, delimiter=",", header="t,w1,w2,w3,w4", comments="")
    options = ["--duration", "0.1", "--commands", "fly.csv", "--log-every", "10", "--quiet"]
    topics = ["--log-topics", "odom,vel_cmd"]
    logs = ["--log", "log.csv", "--log", "log.mat", "--out", "out", "--no-plots"]
    assert main(["run", "quadrotor", *options, *topics, *logs]) == 0
    log_topics.to_csv("python.csv")
    assert Path("log.csv").read_bytes() == Path("python.csv").read_bytes()
    variables = scipy.io.loadmat("log.mat", simplify_cells=True)
    assert np.array_equal(variables["topic_odom"]["z"], log_topics.topics["odom"]["z"])
    assert main(["run", "quadrotor", *options, "--log-topics", "odo"]) == 2
    assert "topic 'odo' does not exist. Did you mean 'odom'?" in (capsys.readouterr().err)


def test_topics_to_log_are_names_each_once():
    simulation = quadrotor()
    assert "topics is 'odom'. Give a list of names" in refusal(simulation.run, 0.1, topics="odom")
    assert "named twice" in refusal(simulation.run, 0.1, topics=["odom", "odom"])
    assert simulation.time == 0
