#!/usr/bin/env python3
"""The node's log, in each format the same flight."""

import os
import resource
import signal
import subprocess
import unittest

import harness
import rosbag
from gazebo_msgs.msg import ModelStates
from harness import Recording, call, commander, description, flight, step
from nav_msgs.msg import Odometry
from test_lockstep import LOCKSTEP, altitude_controller

STEPS = 1000
NOISY = description(positionNoise="0.002")
TOPICS = "_log_topics:=odom vel_cmd"
CUT = "the log is incomplete: File too large"


def fly(log, *arguments, act=lambda node: None):
    """Fly in lockstep and write a log; `act` is called with the node before it flies."""
    with flight(
        *LOCKSTEP, TOPICS, f"_log:={log}", *arguments, urdf=NOISY
    ) as node, commander() as send:
        with Recording("/odom", Odometry, act=lambda m: send(altitude_controller(m))):
            act(node)
            step(STEPS)
        if node.process.poll() is None:
            node.end()
    return node


def converted(log, target):
    """Give what the command without ROS makes of a log."""
    done = subprocess.run(
        [os.environ["QUADCORE_COMMAND"], "convert", str(log), str(target)],
        env={"PATH": os.environ["PATH"]},
        stderr=subprocess.PIPE,
        text=True,
    )
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return target


def messages(bag):
    """Give topic, type, sum, time and bytes of each message, by the tool of ROS."""
    with rosbag.Bag(str(bag)) as opened:
        return [
            (topic, kind, md5sum, time.to_nsec(), data)
            for topic, (kind, data, md5sum, *_), time in opened.read_messages(raw=True)
        ]


class TestLogs(unittest.TestCase):
    def setUp(self):
        self.folder = harness.folder_of(self)

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_who_comes_to_see_while_a_log_is_written_does_not_end_it(self):
        log = self.folder / "flight.mat"
        with flight("_paused:=true", "_engine:=eigen", f"_log:={log}") as node:
            step(100000)
            node.process.send_signal(signal.SIGINT)
            while node.process.poll() is None:
                with Recording("/gazebo/model_states", ModelStates):
                    pass
            status, error = node.result()
        self.assertEqual((status, self.names()), (0, ["flight.mat"]), error)

    def test_each_format_holds_every_bit_of_the_flight(self):
        logs = [self.folder / f"flight.{suffix}" for suffix in ("csv", "mat", "bag")]
        for log in logs:
            log.write_text("older")
            node = fly(log, "_ignore:=drone_plugin")  # which logs tell, too
            self.assertEqual(node.process.returncode, 0, node.error)
        self.assertEqual(self.names(), ["flight.bag", "flight.csv", "flight.mat"])
        own = logs[0].read_bytes()
        self.assertEqual(own.count(b"\n"), 3 + STEPS)
        self.assertIn(b"odom.stamp,odom.x,", own)
        for log in logs[1:]:
            again = converted(log, self.folder / f"from_{log.suffix[1:]}.csv")
            self.assertEqual(again.read_bytes(), own, log)
        # What the command would write, but for names and angles of rotors, which it does not know.
        ours = messages(logs[2])
        theirs = messages(converted(logs[0], self.folder / "theirs.bag"))
        joints = "/joint_states"
        self.assertEqual(
            sorted(m for m in ours if m[0] != joints), sorted(m for m in theirs if m[0] != joints)
        )
        self.assertEqual(
            [m[:4] for m in ours if m[0] == joints], [m[:4] for m in theirs if m[0] == joints]
        )
        with rosbag.Bag(str(logs[2])) as bag, rosbag.Bag(str(self.folder / "theirs.bag")) as other:
            pairs = zip(bag.read_messages(joints), other.read_messages(joints))
            for (_, message, _), (_, same, _) in pairs:
                self.assertEqual(message.velocity, same.velocity)
                self.assertEqual(len(message.name), len(message.position))

    def test_a_killed_node_leaves_an_older_log_and_a_bag_to_reindex(self):
        for suffix in ("mat", "bag"):
            log = self.folder / f"flight.{suffix}"
            log.write_text("older")
            with flight("_paused:=true", f"_log:={log}") as node:
                step(STEPS)
                node.end(signal.SIGKILL)
            self.assertEqual(log.read_text(), "older")
        active = self.folder / "flight.bag.active"
        self.assertEqual(self.names(), ["flight.bag", active.name, "flight.mat"])
        with self.assertRaises(rosbag.ROSBagUnindexedException):
            rosbag.Bag(str(active))
        with rosbag.Bag(str(active), "a", allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
        with rosbag.Bag(str(active)) as bag:
            self.assertGreater(bag.get_message_count("/quadcore/log"), STEPS // 10)

    def test_a_full_disk_cuts_a_bag_short_and_leaves_no_half_of_a_mat(self):
        """A limit of the size of files stands for the disk's."""
        flown = self.folder / "whole.csv"
        fly(flown)
        for suffix, most in (("bag", 250_000), ("mat", 100_000)):
            log = self.folder / f"cut.{suffix}"

            def limit(node, most=most):
                resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE, (most, most))

            node = fly(log, act=limit)
            self.assertEqual(node.process.returncode, 2)
            self.assertEqual(node.error.splitlines()[-1], f"error: {log}: {CUT}")
            self.assertEqual(node.error.count(CUT), 2)  # at once and at the end
        self.assertEqual(self.names(), ["cut.bag", "whole.csv"])
        cut = converted(self.folder / "cut.bag", self.folder / "cut.csv").read_bytes()
        self.assertTrue(flown.read_bytes().startswith(cut))
        self.assertGreater(cut.count(b"\n"), STEPS // 10)

    def test_a_log_that_cannot_be_kept_is_not_overwritten(self):
        """A full disk, for which a limit of the size of files stands."""
        log = self.folder / "flight.csv"
        with flight("_paused:=true", f"_log:={log}") as node:
            resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE, (20_000, 20_000))
            step(STEPS)
            call("/gazebo/reset_simulation")
            step(STEPS)
            node.end()
        self.assertEqual((node.process.returncode, self.names()), (2, ["flight.csv"]))
        self.assertEqual(node.error.splitlines()[-1], f"error: {log}: {CUT}")
        self.assertEqual(log.stat().st_size, 20_000)

    def test_a_log_that_cannot_be_written_is_refused_before_the_flight(self):
        for suffix in ("csv", "mat", "bag"):
            path = f"/none/flight.{suffix}"
            status, error = harness.outcome(f"_log:={path}")
            self.assertEqual(status, 2)
            self.assertIn(f"error: {path}: cannot be written: No such file or directory", error)


if __name__ == "__main__":
    harness.run("logs", TestLogs)
