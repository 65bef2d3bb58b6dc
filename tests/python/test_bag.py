"""Bags of ROS: logs in them, and what comes out of those that the node's topics fill."""

import os
import subprocess

import numpy as np
import pytest
from processes import run_command, run_refused

import quadcore as qc
from quadcore.formats import bag

rosbags = pytest.importorskip("rosbags")

ODD = {"odometry.positionNoise": 0.1, "odometry.rate": 250}


@pytest.fixture(scope="module")
def log():
    """A flight whose log has everything: topics at other rates, wrenches, something ignored."""
    simulation = qc.Simulation("quadrotor", "eigen", parameters=ODD, dt=1 / 3000)
    flown = simulation.run(
        0.1, [[0, 480, -470, 490, -475]], topics=["odom", "vel_cmd"], wrenches=True
    )
    flown.ignored.extend(["libcamera.so", "a thing, with a comma"])
    return flown


def assert_same(read, log):
    np.testing.assert_array_equal(read.table.view("u8"), log.table.view("u8"))
    assert list(read.wrenches) == list(log.wrenches)
    for name, wrench in log.wrenches.items():
        np.testing.assert_array_equal(read.wrenches[name], wrench)
    assert {t: list(f) for t, f in read.topics.items()} == {
        t: list(f) for t, f in log.topics.items()
    }
    for topic, fields in log.topics.items():
        for field, column in fields.items():
            np.testing.assert_array_equal(read.topics[topic][field], column)


def test_a_log_goes_round_all_formats_bit_for_bit(log, tmp_path):
    log.ignored[:] = ["libcamera.so", "thing"]
    log.to_csv(tmp_path / "a.csv")
    formats = "a.csv", "b.mat", "c.bag", "c.ros2", "d.csv"
    for source, target in zip(formats, formats[1:]):
        done = run_command("convert", str(tmp_path / source), str(tmp_path / target))
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
        assert_same(qc.Log.of_file(tmp_path / target), log)
    assert (tmp_path / "d.csv").read_bytes() == (tmp_path / "a.csv").read_bytes()


def test_what_a_killed_conversion_left_goes_with_the_next(log, tmp_path):
    """Of a process that has gone; one that runs is at work."""
    gone = subprocess.Popen(["true"])
    gone.wait()
    log.to_file(tmp_path / "a.csv")
    others = [f".b.bag.{os.getpid()}.part", ".c.bag.1.part", ".b.bag.mine.part"]
    for name in (f".b.bag.{gone.pid}.part", f".b.bag.{gone.pid}.rows.part", *others):
        (tmp_path / name).touch()
    done = run_command("convert", str(tmp_path / "a.csv"), str(tmp_path / "b.bag"))
    assert done.returncode == 0, done.stderr
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == sorted(["a.csv", "b.bag", *others])


def test_what_was_ignored_stays_known(log, tmp_path):
    log.to_file(tmp_path / "a.bag")
    assert qc.Log.of_file(tmp_path / "a.bag").ignored == log.ignored


def messages(path, topic):
    from rosbags.rosbag1 import Reader

    store = bag.Messages().store
    with Reader(path) as reader:
        found = [c for c in reader.connections if c.topic == topic]
        for connection, time, data in reader.messages(found) if found else ():
            yield time, store.deserialize_ros1(data, connection.msgtype)


def test_a_flight_is_recorded_on_the_topics_of_the_node(tmp_path):
    path = tmp_path / "flight.bag"
    done = run_command("run", "quadrotor", "--engine", "eigen", "--duration", "0.1", "--set",
               "odometry.rate=500", "--log-topics", "odom", "--log", str(path),
               "--log", str(tmp_path / "flight.csv"))  # fmt: skip
    assert done.returncode == 0, done.stderr
    log = qc.Log.of_file(tmp_path / "flight.csv")
    assert_same(qc.Log.of_file(path), log)
    truth = list(messages(path, "/ground_truth/odometry"))
    assert len(truth) == 101 and len(list(messages(path, "/odom"))) == 51
    time, last = truth[-1]
    assert time == 100_000_000 == last.header.stamp.nanosec
    assert (last.header.frame_id, last.child_frame_id) == ("world", "drone")
    assert last.pose.pose.position.z == log.position[-1, 2]
    assert last.pose.covariance[0] == 1e-12
    assert [t for t, _ in messages(path, "/clock")] == [
        1,
        *range(20_000_000, 101_000_000, 20_000_000),
    ]
    [joints] = [m for t, m in messages(path, "/joint_states") if t == time]
    np.testing.assert_array_equal(joints.velocity, log.rotor_velocity[-1])
    transform = list(messages(path, "/tf"))[-1][1].transforms[0]
    assert (transform.child_frame_id, transform.transform.translation.z) == (
        "drone", log.position[-1, 2]
    )  # fmt: skip


def write(path, topic, times, rows, kind="std_msgs/msg/Float64MultiArray"):
    from rosbags.rosbag1 import Writer

    maker = bag.Messages()
    with Writer(path) as writer:
        connection = writer.add_connection(topic, kind, typestore=maker.store)
        for time, row in zip(times, rows):
            writer.write(
                connection, time, maker.make_array(row, maker.make_layout(["w"], len(row)))
            )


@pytest.mark.parametrize("start", [0, 1_700_000_000 * 10**9])
def test_recorded_commands_fly(start, tmp_path):
    """By the simulated clock, or by one on the wall, which counts from the bag's start."""
    rows = np.array([[480.0, -470, 490, -475], [470, -480, 480, -490]])
    times = [start or 1, start + 30_000_000]
    write(tmp_path / "commands.bag", "/quadrotor/vel_cmd", times, rows)
    flown = qc.Simulation("quadrotor", "eigen").run(0.1, tmp_path / "commands.bag")
    table = np.column_stack([[0, 0.03], rows])
    expected = qc.Simulation("quadrotor", "eigen").run(0.1, table)
    np.testing.assert_array_equal(flown.table, expected.table)


def test_a_logged_flight_is_flown_again_from_its_bag(tmp_path):
    commands = [[0, 480, -470, 490, -475], [0.05, 470, -480, 480, -490]]
    log = qc.Simulation("quadrotor").run(0.1, commands, topics=["vel_cmd"])
    log.to_file(tmp_path / "flight.bag")
    again = qc.Simulation("quadrotor").run(0.1, tmp_path / "flight.bag")
    np.testing.assert_array_equal(again.table, log.table)


def test_a_flight_is_followed_from_its_bag(tmp_path):
    simulation = qc.Simulation("quadrotor", "eigen")
    simulation.run(0.4, [[0, 480, -480, 480, -480]], 100).to_file(tmp_path / "way.bag")
    path = qc.Log.of_file(tmp_path / "way.bag")
    reference = qc.references.parse(f"series:{tmp_path / 'way.bag'}")
    np.testing.assert_allclose(reference(0.3).position, path.position[3], atol=1e-9)


def test_what_cannot_be_read_is_one_line(tmp_path):
    rows = [[1.0, 2.0]]
    write(tmp_path / "other.bag", "/odd", [1], rows)
    write(tmp_path / "short.bag", "/vel_cmd", [1], rows)
    write(tmp_path / "reset.bag", "/vel_cmd", [0, 20, 0, 10], [[1.0, -1, 1, -1]] * 4)
    (tmp_path / "text.bag").write_text("t,w1\n")
    (tmp_path / "empty.bag").write_bytes(b"")
    for name, says in (
        ("other.bag", "topics of commands: none. Record one topic that ends in vel_cmd"),
        (
            "short.bag",
            "/vel_cmd: a message of 2 numbers, but the model has 4 rotors. Record w",
        ),
        ("reset.bag", "/vel_cmd: its time goes back, as after a reset"),
        ("text.bag", "is no bag that can be read"),
        ("empty.bag", "is no bag that can be read"),
        ("none.bag", "cannot be read"),
    ):
        error = run_refused("run", "quadrotor", "--commands", str(tmp_path / name))
        assert f"{name}: {says}" in error
    for name in ("other.bag", "text.bag"):
        with pytest.raises(qc.InputError, match=r"topics that end in ground_truth|is no bag"):
            qc.Log.of_file(tmp_path / name)
    assert run_refused("convert", str(tmp_path / "other.bag"), "x.txt").count("logs are written to")


SYSTEM = "/usr/bin/python3"
READ = """
import sys, rosbag
with rosbag.Bag(sys.argv[1]) as bag:
    for topic, info in sorted(bag.get_type_and_topic_info().topics.items()):
        print(topic, info.msg_type, info.message_count)
    for topic, message, time in bag.read_messages(["/ground_truth/odometry", "/quadcore/log"]):
        last = message
    print(repr(message.data[3]), time.to_nsec(), message._md5sum)
"""


def has_rosbag():
    done = subprocess.run([SYSTEM, "-c", "import rosbag, tf2_msgs"], capture_output=True)
    return done.returncode == 0


@pytest.mark.skipif(not has_rosbag(), reason="needs ROS' own rosbag")
def test_the_rosbag_of_ros_reads_what_was_written(log, tmp_path):
    log.to_file(tmp_path / "flight.bag")
    done = subprocess.run(
        [SYSTEM, "-c", READ, str(tmp_path / "flight.bag")], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    *topics, last = done.stdout.splitlines()
    rows = len(log)
    slow = len(np.unique(np.floor(log.time / 0.02 + 1e-6)))
    commands = len(np.unique(log.topics["vel_cmd"]["stamp"][1:]))
    assert topics == [
        f"/clock rosgraph_msgs/Clock {slow}",
        f"/ground_truth/odometry nav_msgs/Odometry {rows}",
        f"/joint_states sensor_msgs/JointState {slow}",
        f"/odom nav_msgs/Odometry {len(np.unique(log.topics['odom']['stamp']))}",
        f"/quadcore/log std_msgs/Float64MultiArray {rows}",
        f"/tf tf2_msgs/TFMessage {slow}",
        f"/vel_cmd std_msgs/Float64MultiArray {commands}",
    ]
    height, time, md5 = last.split()
    assert float(height) == log.position[-1, 2] and int(time) == round(log.time[-1] * 1e9)
    assert md5 == "4b7d974086d4060e7db4613a7e6c3ba4"


def test_ros_2_reads_a_bag_with_its_own_types(log, tmp_path):
    """The rows of a log, with one store of types of rosbags that quadcore does not use itself."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    folder = tmp_path / "flight.ros2"
    log.to_file(folder)
    assert sorted(file.name for file in folder.iterdir()) == ["flight.ros2.db3", "metadata.yaml"]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["flight.ros2"]
    with AnyReader([folder], default_typestore=get_typestore(Stores.ROS2_FOXY)) as reader:
        kinds = {c.topic: c.msgtype for c in reader.connections}
        assert kinds["/clock"] == "rosgraph_msgs/msg/Clock"
        assert kinds["/tf"] == "tf2_msgs/msg/TFMessage"
        wanted = [c for c in reader.connections if c.topic == "/ground_truth/odometry"]
        read = [reader.deserialize(data, c.msgtype) for c, _, data in reader.messages(wanted)]
    assert len(read) == len(log.time)
    assert not hasattr(read[0].header, "seq")  # which ROS 2 does not have
    for message, time, position, rates in zip(read, log.time, log.position, log.angular_velocity):
        stamp, p, w = message.header.stamp, message.pose.pose.position, message.twist.twist.angular
        assert stamp.sec + stamp.nanosec / 1e9 == pytest.approx(time, abs=1e-9)
        assert ((p.x, p.y, p.z), (w.x, w.y, w.z)) == (tuple(position), tuple(rates))


def test_a_ros_2_bag_of_the_node_topics_alone_is_a_log(log, tmp_path, monkeypatch):
    monkeypatch.setattr(bag, "LOG", "/another/topic")  # as a recording of ros2 bag has it
    log.to_file(tmp_path / "flight.ros2")
    monkeypatch.undo()
    folder = (tmp_path / "flight.ros2").rename(tmp_path / "rosbag2_2026_01_31")
    read = qc.Log.of_file(folder)
    np.testing.assert_array_equal(read.position, log.position)
    np.testing.assert_array_equal(read.rotor_velocity, log.rotor_velocity)


def test_a_ros_2_bag_replaces_nothing_and_leaves_no_parts(log, tmp_path, monkeypatch):
    (tmp_path / "flight.ros2").mkdir()
    with pytest.raises(qc.InputError, match=r"flight.ros2: exists already. Name a new folder."):
        log.to_file(tmp_path / "flight.ros2")

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(bag, "_write_rows", fail)
    with pytest.raises(qc.InputError, match=r"b\.ros2: cannot be written: No space left on device"):
        log.to_file(tmp_path / "b.ros2")
    assert [file.name for file in tmp_path.iterdir()] == ["flight.ros2"]


def test_a_damaged_ros_2_bag_is_one_line(log, tmp_path):
    log.to_file(tmp_path / "flight.ros2")
    (tmp_path / "flight.ros2" / "flight.ros2.db3").write_bytes(b"no database")
    error = run_refused("convert", str(tmp_path / "flight.ros2"), str(tmp_path / "a.csv"))
    assert "is no bag that can be read" in error
