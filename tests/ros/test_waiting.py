#!/usr/bin/env python3
"""A flight in lockstep that nobody commands shows its start, and says why it waits."""

import unittest

import harness
import rospy
from harness import HOVER, LONG, Recording, commander, flight
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log

ALONE = ("_lockstep:=true", "_lockstep_timeout:=30", "_real_time_factor:=0")


def tick(message):
    """Steps since the start."""
    return round(message.header.stamp.to_sec() * 1000)


class TestWaiting(unittest.TestCase):
    def test_the_truth_of_the_start_is_sent_to_who_comes(self):
        for arguments in (ALONE, (*ALONE, "_paused:=true")):
            with flight(*arguments):
                for _ in "ab":  # the second one, too
                    truth = rospy.wait_for_message("/ground_truth/odometry", Odometry, LONG)
                    self.assertEqual(truth.pose.pose.position.z, 10)

    def test_a_node_that_waits_for_odometry_before_it_commands_flies(self):
        with flight(*ALONE):
            first = rospy.wait_for_message("/odom", Odometry, LONG)
            self.assertEqual(tick(first), 0)
            with commander() as send, Recording(
                "/odom", Odometry, act=lambda _: send(HOVER)
            ) as odometry:
                flown = odometry.wait_for_count(101)
        # The start again, which is answered, and then each step once.
        self.assertEqual([tick(m) for m in flown[:101]], list(range(101)))

    def test_odometry_is_not_shown_again_to_who_has_seen_it(self):
        with flight(*ALONE) as node, Recording("/odom", Odometry) as odometry:
            odometry.wait_for_count(1)
            with Recording("/rosout", Log) as rosout:
                rosout.wait(lambda logs: sum("no node publishes" in log.msg for log in logs) >= 2)
            self.assertEqual([tick(m) for m in odometry.messages], [0])
            node.end()

    def test_the_reason_is_said_again_and_again(self):
        with flight(*ALONE) as node, Recording("/rosout", Log) as rosout:
            rosout.wait(lambda logs: sum("no node publishes" in log.msg for log in logs) >= 2)
            node.end()
        reason = (
            "lockstep: no node publishes on /quadrotor/vel_cmd. The flight waits at "
            "t = 0.000000 s. Start the controller, or run without lockstep."
        )
        self.assertGreaterEqual(node.error.count(reason), 2, node.error)


if __name__ == "__main__":
    harness.run("waiting", TestWaiting)
