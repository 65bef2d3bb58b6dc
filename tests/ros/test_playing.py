#!/usr/bin/env python3
"""A recording that is played in lockstep gives the flight that was recorded."""

import unittest

import harness
import rosbag
from harness import Process, Recording, commander, diagnostic, flight, step
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64MultiArray
from test_lockstep import LOCKSTEP, altitude_controller

STEPS = 1000
TOPIC = "/quadrotor/vel_cmd"


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
            (self.folder / "none.bag", (), "no such file; give a bag"),
            (empty, (), "topics of commands: none; name one as _topic:=NAME"),
            (other, ("_topic:=/odom",), "no topic /odom of std_msgs/Float64MultiArray"),
            (text, (), "is no bag that can be read"),
        ):
            with Process("bag_player.py", str(path), *arguments) as player:
                status, error = player.result()
            self.assertEqual(status, 1)
            lines = [line for line in error.splitlines() if line]
            self.assertEqual(len(lines), 1, error)
            self.assertIn(f"error: {path}: {message}", error)


if __name__ == "__main__":
    harness.run("playing", TestPlaying)
