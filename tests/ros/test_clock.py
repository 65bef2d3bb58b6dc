#!/usr/bin/env python3
"""One clock: who leads it, who follows, and what pause and reset do to either."""

import time
import unittest

import harness
import numpy as np
import rosgraph
import rospy
from harness import Process, Recording, call, flight, step
from nav_msgs.msg import Odometry
from quadcore.srv import Step
from rosgraph_msgs.msg import Clock

FAST = "_real_time_factor:=0"


def seconds(message):
    return message.header.stamp.to_sec()


def nanoseconds(messages):
    return [m.clock.to_nsec() for m in messages]


def has_services(node):
    _, _, services = rosgraph.Master(rospy.get_name()).getSystemState()
    return any(node in providers for name, providers in services if "logger" not in name)


class TestClock(unittest.TestCase):
    def test_the_second_node_follows_the_first(self):
        with flight("_paused:=true", namespace="/a"):
            step(1000, "/a")
            with flight("_name:=b", "_z:=20", namespace="/b"), Recording("/b/odom", Odometry) as b:
                self.assertEqual(harness.publishers("/clock"), ["/a/quadcore"])
                start = b.wait_for_count(1)[0]  # a leader that is paused has a time, too
                self.assertEqual(seconds(start), 1)
                self.assertEqual(start.pose.pose.position.z, 20)
                step(500, "/a")
                flown = b.wait(lambda m: seconds(m[-1]) == 1.5)
        self.assertEqual(
            [m.header.stamp.to_nsec() for m in flown],
            [1000000000 + i * 1000000 for i in range(501)],
        )
        self.assertAlmostEqual(flown[-1].pose.pose.position.z, 20 - 4.9 * 0.25, delta=0.01)

    def test_a_leader_in_a_hurry_waits_for_its_followers(self):
        with flight("_paused:=true", FAST, namespace="/a"):
            topics = Recording("/clock", Clock), Recording("/b/odom", Odometry)
            with flight("_name:=b", FAST, namespace="/b"), topics[0] as clock, topics[1] as b:
                b.wait_for_publisher()
                call("/a/gazebo/unpause_physics")
                clock.wait(lambda m: m and m[-1].clock.to_sec() > 5)
                call("/a/gazebo/pause_physics")
                stopped = harness.time_of_flight("/a").to_sec()
                b.wait(lambda m: m and seconds(m[-1]) == stopped)
            ticks = nanoseconds(clock.messages)
        self.assertEqual(ticks, sorted(ticks))

    def test_a_follower_that_is_paused_stands_alone_and_goes_on_at_the_time_of_the_clock(self):
        topic = Recording("/b/odom", Odometry)
        follower = flight("_name:=b", namespace="/b")
        with flight("_paused:=true", namespace="/a"), follower, topic as b:
            b.wait_for_publisher()
            step(100, "/a")
            stood = b.wait(lambda m: m and seconds(m[-1]) == 0.1)[-1]
            call("/b/gazebo/pause_physics")
            step(1000, "/a")
            call("/b/gazebo/unpause_physics")
            step(10, "/a")  # it joins between two of them
            on = b.wait(lambda m: seconds(m[-1]) == 1.11)
        times = np.array([seconds(message) for message in on])
        (gap,) = np.flatnonzero(np.diff(times) > 0.0015)  # in which nothing was flown
        self.assertEqual(gap, 99)
        flown = 0.001 * (len(on) - 100)  # the last of the clock may still have been on its way
        fall = stood.pose.pose.position.z - on[-1].pose.pose.position.z
        self.assertAlmostEqual(fall, 0.98 * flown + 4.9 * flown**2, delta=1e-4)

    def test_resets_are_independent_and_never_set_a_shared_clock_back(self):
        with flight("_paused:=true", namespace="/a"), flight("_name:=b", namespace="/b"):
            flights = Recording("/a/odom", Odometry), Recording("/b/odom", Odometry)
            with Recording("/clock", Clock) as clock, flights[0] as a, flights[1] as b:
                for recording in (clock, a, b):
                    recording.wait_for_publisher()
                step(200, "/a")
                b.wait(lambda m: m and seconds(m[-1]) == 0.2)
                call("/a/gazebo/reset_simulation")
                step(200, "/a")
                b.wait(lambda m: seconds(m[-1]) == 0.4)
                call("/b/gazebo/reset_simulation")
                b.wait(lambda m: m[-1].pose.pose.position.z == 10)
                step(1, "/a")
                a.wait(lambda m: seconds(m[-1]) == 0.401)
                b.wait(lambda m: seconds(m[-1]) == 0.401)
        ticks = nanoseconds(clock.messages)
        self.assertEqual(ticks, sorted(ticks))
        for recording, reset_at in ((a, 0.2), (b, 0.4)):
            starts = [seconds(m) for m in recording.messages if m.pose.pose.position.z == 10]
            self.assertEqual(starts, [reset_at])

    def test_a_clock_that_is_set_back_is_followed(self):
        topic = Recording("/b/odom", Odometry)
        with flight("_paused:=true"), flight("_name:=b", namespace="/b"), topic as b:
            b.wait_for_publisher()
            step(300)
            high = b.wait(lambda m: m and seconds(m[-1]) == 0.3)[-1]
            call("/gazebo/reset_simulation")  # without a namespace the clock is its own
            step(10)  # it joins between two of them
            low = b.wait(lambda m: seconds(m[-1]) == 0.01)[-1]
        self.assertLess(low.pose.pose.position.z, high.pose.pose.position.z)

    def test_there_is_one_leader_only(self):
        with flight("_paused:=true", namespace="/a"):
            rospy.set_param("/b/robot_description", harness.description())
            with Process("quadcore_node", "__ns:=/b", "_name:=b", "_clock:=lead") as second:
                status, error = second.result()
            rospy.delete_param("/b/quadcore")
        self.assertEqual(status, 2)
        self.assertIn("error: parameter ~clock: is lead, but /a/quadcore already publishes", error)

    def test_a_follower_makes_no_steps_of_its_own(self):
        with flight("_clock:=follow", namespace="/b"):
            response = rospy.ServiceProxy("/b/quadcore/step", Step)(1)
        self.assertFalse(response.success)
        self.assertEqual(
            response.message, "This vehicle follows /clock. Step the node that leads it."
        )

    def test_a_leader_that_was_killed_leads_no_more(self):
        with flight("_paused:=true", namespace="/a") as node:
            node.process.kill()
            node.process.wait()
            with flight("_paused:=true", namespace="/b"):
                step(1, "/b")

    def test_who_makes_the_time_says_that_there_is_one(self):
        for before, after in ((None, True), (False, False)):
            if rospy.has_param("/use_sim_time"):
                rospy.delete_param("/use_sim_time")
            if before is not None:
                rospy.set_param("/use_sim_time", before)
            with flight("_paused:=true"):
                self.assertEqual(rospy.get_param("/use_sim_time"), after)
        rospy.delete_param("/use_sim_time")

    def test_it_is_said_before_the_first_service_can_be_found(self):
        deadline = time.monotonic() + harness.LONG
        rospy.set_param("/robot_description", harness.description())
        if rospy.has_param("/use_sim_time"):
            rospy.delete_param("/use_sim_time")
        with Process("quadcore_node", "__name:=early", "_paused:=true"):
            while not has_services("/early"):
                self.assertLess(time.monotonic(), deadline)
            said = rospy.has_param("/use_sim_time")
        rospy.delete_param("/use_sim_time")
        rospy.delete_param("/early")
        self.assertTrue(said)


if __name__ == "__main__":
    harness.run("clock", TestClock)
