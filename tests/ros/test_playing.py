#!/usr/bin/env python3
"""A recording that is played in lockstep gives the flight that was recorded."""

import contextlib
import os
import subprocess
import threading
import unittest
import xmlrpc.client

import harness
import numpy as np
import rosbag
import rosgraph
import rospy
import scipy.io
from harness import (
    Process,
    Recording,
    call,
    commander,
    diagnostic,
    flight,
    step,
)
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from test_lockstep import LOCKSTEP, altitude_controller

import quadcore as qc

STEPS = 1000
STEP = 1_000_000  # ns
TOPIC = "/quadrotor/vel_cmd"


def connected(other):
    """Topics, and whether in or out, by which the plant's node is connected with another."""
    master = rosgraph.Master("/playing")
    plant = xmlrpc.client.ServerProxy(master.lookupNode("/quadcore"))
    others = {other}
    with contextlib.suppress(rosgraph.MasterException):
        others.add(master.lookupNode(other))
    _, _, found = plant.getBusInfo("/playing")
    return {(topic, way) for _, who, way, _, topic, *_ in found if who in others}


class TestPlaying(unittest.TestCase):
    def setUp(self):
        self.folder = harness.folder_of(self)

    def record(self, log):
        """Fly under a controller and record its commands; return the bag.

        Not by `rosbag record`, whose queue of 100 messages loses some on a busy machine.
        """
        bag = self.folder / "flight.bag"
        with rosbag.Bag(str(bag), "w") as written, Recording(
            TOPIC, Float64MultiArray, act=lambda message: written.write(TOPIC, message)
        ) as commands, flight(*LOCKSTEP, f"_log:={log}"), commander(listeners=2) as send:

            def answer(message):
                send(altitude_controller(message))

            with Recording("/odom", Odometry, act=answer):
                step(STEPS)
                commands.wait(lambda m: len(m) > STEPS)
        return bag

    def test_a_bag_of_the_node_is_replayed_byte_for_byte(self):
        flown, again = self.folder / "flown.bag", self.folder / "again.bag"
        commands = "_log_topics:=vel_cmd"
        with flight(*LOCKSTEP, commands, f"_log:={flown}"), commander() as send:

            def answer(message):
                # A command after the last step might be logged or not.
                if message.header.stamp.to_nsec() < STEPS * STEP:
                    send(altitude_controller(message))

            with Recording("/odom", Odometry, act=answer):
                step(STEPS)
        player = ("bag_player.py", str(flown), "vel_cmd:=quadrotor/vel_cmd")
        with flight(*LOCKSTEP, commands, f"_log:={again}"), Process(*player) as played:
            step(STEPS)
            played.process.wait(harness.LONG)  # it ends with the recording
        self.assertEqual(flown.read_bytes(), again.read_bytes())

    def test_a_played_bag_gives_the_same_log(self):
        recorded, played = self.folder / "recorded.csv", self.folder / "played.csv"
        bag = self.record(recorded)
        with rosbag.Bag(str(bag)) as messages:
            self.assertEqual(messages.get_message_count(TOPIC), STEPS + 1)
        with flight(*LOCKSTEP, f"_log:={played}"), Process("bag_player.py", str(bag)):
            step(STEPS)
            self.assertEqual(diagnostic("late commands"), 0)
        self.assertEqual(len(recorded.read_text().splitlines()), STEPS + 2)
        self.assertEqual(recorded.read_bytes(), played.read_bytes())

    def test_what_the_node_published_becomes_its_own_log(self):
        """Read without ROS, from a bag, every bit of the rows whose topics are all there."""
        own, bag, log = (self.folder / name for name in ("own.csv", "flight.bag", "log.csv"))
        lock = threading.Lock()
        topics = {"/clock": Clock, "/ground_truth/odometry": Odometry, "/joint_states": JointState}
        with rosbag.Bag(str(bag), "w") as written, contextlib.ExitStack() as recordings:

            def keep(topic):
                def write(message):
                    with lock:
                        written.write(topic, message)

                return write

            with flight(*LOCKSTEP[:1], f"_log:={own}"), commander() as send:
                heard = [
                    recordings.enter_context(Recording(topic, kind, act=keep(topic)))
                    for topic, kind in topics.items()
                ]
                for recording in heard:
                    recording.wait_for_count(1)  # what is kept for newcomers
                send([480.0, -470.0, 490.0, -475.0])
                step(200)
                heard[0].wait(lambda m: m[-1].clock.to_nsec() == 200_000_000)
                for recording in heard[1:]:
                    recording.wait(lambda m: m[-1].header.stamp.to_nsec() == 200_000_000)
                recordings.close()
        done = subprocess.run(
            [os.environ["QUADCORE_COMMAND"], "convert", str(bag), str(log)],
            env={"PATH": os.environ["PATH"]},
            stderr=subprocess.PIPE,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        ours, theirs = own.read_text().splitlines(), log.read_text().splitlines()
        self.assertGreater(len(theirs), 10)
        self.assertLessEqual(set(theirs), set(ours))
        self.assertEqual(theirs[-1], ours[-1])

    def test_commands_of_a_file_fly_as_without_ros(self):
        """In lockstep, and the odometry is kept."""
        commands, own = self.folder / "c.csv", self.folder / "own.csv"
        commands.write_text("t,w1,w2,w3,w4\n0,480,-470,490,-475\n0.05,470,-480,480,-490\n")
        bag = self.folder / "c.bag"
        rows = [[480.0, -470.0, 490.0, -475.0], [470.0, -480.0, 480.0, -490.0]]
        with rosbag.Bag(str(bag), "w") as written:
            for time, row in zip((rospy.Time(0, 1), rospy.Time(0, 50_000_000)), rows):
                written.write("/quadrotor/vel_cmd", Float64MultiArray(data=row), time)
        matrix = self.folder / "c.mat"
        scipy.io.savemat(str(matrix), {"commands": [[0.0, *rows[0]], [0.05, *rows[1]]]})
        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1}, spawn=(0, 0, 10))
        flown = simulation.run(0.1, commands)
        for file, suffix in ((commands, "csv"), (bag, "csv"), (matrix, "mat")):
            out = self.folder / f"odometry.{suffix}"
            arguments = (str(file), "_lockstep:=true", "_duration:=0.1", f"_out:={out}")
            with flight(*LOCKSTEP, f"_log:={own}"), Process("play_commands.py", *arguments) as node:
                step(100)
                status, error = node.result()
                self.assertEqual(status, 0, error)
            np.testing.assert_array_equal(qc.Log.of_file(own).table, flown.table)
            kept = qc.Log.of_file(out).table
            np.testing.assert_array_equal(kept[:, 1:], flown.table[:, 1:14])
            out.unlink()

    def test_commands_of_a_file_are_sent_at_their_times_by_the_odometry(self):
        """Each once, in order and never early, however late the plant listens."""
        times = 0.05 * np.arange(8)
        table = np.column_stack([times, *(sign * (480 + np.arange(8)) for sign in (1, -1, 1, -1))])
        file, out, own = (self.folder / name for name in ("c.mat", "odometry.mat", "own.csv"))
        scipy.io.savemat(str(file), {"t": times, **{f"w{i}": table[:, i] for i in range(1, 5)}})
        arguments = (str(file), "_duration:=0.4", f"_out:={out}")
        slow = ("_paused:=true", "_real_time_factor:=0.1", "_log_topics:=vel_cmd", f"_log:={own}")
        with flight(*slow), Process("play_commands.py", *arguments) as node:
            harness.wait_until(
                lambda: {("/odom", "o"), (TOPIC, "i")} <= connected("/play_commands")
            )
            call("/gazebo/unpause_physics")
            status, error = node.result()
            self.assertEqual(status, 0, error)
            diagnostic("commands", lambda count: count == len(table))
        log = qc.Log.of_file(own)
        sent = np.column_stack(
            [log.topics["vel_cmd"][n] for n in ("stamp", "w1", "w2", "w3", "w4")]
        )
        sent = sent[np.isfinite(sent[:, 0])]
        sent = sent[np.append(True, np.diff(sent[:, 0]) > 0)]
        np.testing.assert_array_equal(sent[:, 1:], table[:, 1:])
        self.assertTrue((sent[:, 0] >= times - 1e-9).all(), sent[:, 0])
        kept = qc.Log.of_file(out).table
        np.testing.assert_allclose(kept[:, 0], 0.001 * np.arange(401), atol=1e-9)
        at = np.searchsorted(log.time, kept[:, 0] - 1e-6)
        np.testing.assert_array_equal(kept[:, 1:], log.table[at, 1:14])

    def test_the_player_ends_with_its_recording(self):
        bag = self.folder / "short.bag"
        with rosbag.Bag(str(bag), "w") as messages:
            for speed in (470.0, 471.0, 472.0):
                messages.write(TOPIC, Float64MultiArray(data=[speed, -speed, speed, -speed]))
        with flight(*LOCKSTEP, "_paused:=false", "_lockstep_timeout:=0.2"):
            with Process("bag_player.py", str(bag)) as player:
                status, _ = player.result()
            diagnostic("commands", lambda count: count == 3)
        self.assertEqual(status, 0)

    def test_what_cannot_be_played_is_one_line(self):
        empty, other = self.folder / "empty.bag", self.folder / "other.bag"
        rosbag.Bag(str(empty), "w").close()
        with rosbag.Bag(str(other), "w") as messages:
            messages.write("/odom", Odometry())
        text = self.folder / "text.bag"
        text.write_text("t,w1\n")
        for path, arguments, message in (
            (self.folder / "none.bag", (), "does not exist. Name a bag"),
            (empty, (), "topics of commands: none. Choose one with _topic:=NAME."),
            (other, ("_topic:=/odom",), "no topic /odom of type std_msgs/Float64MultiArray"),
            (text, (), "cannot be read as a bag"),
        ):
            with Process("bag_player.py", str(path), *arguments) as player:
                status, error = player.result()
            self.assertEqual(status, 1)
            lines = [line for line in error.splitlines() if line]
            self.assertEqual(len(lines), 1, error)
            self.assertIn(f"error: {path}: {message}", error)


if __name__ == "__main__":
    harness.run("playing", TestPlaying)
