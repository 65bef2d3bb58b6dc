#!/usr/bin/env python3
"""Pause, step, reset and set_state."""

import threading
import unittest

import harness
import numpy as np
import rospy
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from harness import HOVER, Recording, call, commander, diagnostic, flight, step
from nav_msgs.msg import Odometry
from quadcore.srv import SetState, Step
from rosgraph_msgs.msg import Clock

import quadcore as qc

POSE = Pose(Point(1, -2, 30), Quaternion(0.5, -0.5, 0.5, 0.5))
TWIST = Twist(Vector3(3, 2, -1), Vector3(0.5, -0.25, 2))
ROTORS = [400.0, -410.0, 420.0, -430.0]


def set_state(pose=POSE, twist=TWIST, rotors=()):
    return rospy.ServiceProxy("/quadcore/set_state", SetState)(pose, twist, rotors)


def reset(*_):
    call("/gazebo/reset_simulation")


def times(messages):
    return [message.clock.to_nsec() for message in messages]


class TestServices(unittest.TestCase):
    def test_pause_and_unpause(self):
        with flight(), Recording("/clock", Clock) as clock:
            clock.wait_for_count(10)
            call("/gazebo/pause_physics")
            paused_at = harness.time_of_flight()
            clock.wait(lambda messages: messages[-1].clock == paused_at)
            rospy.sleep(0.2)
            self.assertEqual(clock.messages[-1].clock, paused_at)
            call("/gazebo/unpause_physics")
            clock.wait(lambda messages: messages[-1].clock > paused_at)

    def test_step_flies_n_steps_and_publishes_them_before_it_returns(self):
        with flight("_paused:=true"), Recording("/clock", Clock) as clock:
            clock.wait_for_publisher()
            proxy = rospy.ServiceProxy("/quadcore/step", Step)
            for n, reached in ((1, 1), (0, 1), (10, 11), (100, 111)):
                response = proxy(n)
                self.assertEqual((response.success, response.message), (True, ""))
                self.assertEqual(response.stamp.to_nsec(), reached * 1000000)
            ticks = clock.wait_for_count(111)
        self.assertEqual(times(ticks), [i * 1000000 for i in range(1, 112)])

    def test_step_pauses_a_running_flight_and_is_cut_short_by_a_pause(self):
        with flight():
            step(1)
            with Recording("/clock", Clock) as clock:
                clock.wait_for_publisher()
                rospy.sleep(0.2)
                self.assertEqual(clock.messages, [])
            with Recording("/clock", Clock, act=lambda _: call("/gazebo/pause_physics")):
                response = rospy.ServiceProxy("/quadcore/step", Step)(100000)
            self.assertFalse(response.success)
            self.assertRegex(response.message, "Stopped [0-9]+ steps before the end.")

    def test_reset_simulation_is_the_start_again(self):
        with flight("_paused:=true"), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            step(50)
            flown = odometry.wait_for_count(50)
            call("/gazebo/reset_simulation")
            start = odometry.wait_for_count(51)[-1]
            self.assertEqual(start.header.stamp.to_nsec(), 0)
            self.assertEqual(start.pose.pose.position, Point(0, 0, 10))
            step(50)
            again = odometry.wait_for_count(101)[51:]
        for first, second in zip(flown, again):
            first.header.seq = second.header.seq = 0
            self.assertEqual(first, second)

    def test_reset_world_keeps_the_time(self):
        with flight("_paused:=true"), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            step(50)
            call("/gazebo/reset_world")
            start = odometry.wait_for_count(51)[-1]
            step(1)
            after = odometry.wait_for_count(52)[-1]
        self.assertEqual(start.header.stamp.to_nsec(), 50000000)
        self.assertEqual(start.pose.pose.position, Point(0, 0, 10))
        self.assertEqual(after.header.stamp.to_nsec(), 51000000)

    def test_a_reset_lets_the_motors_go(self):
        with flight(), commander() as send, Recording("/odom", Odometry) as odometry:
            send(HOVER)
            odometry.wait(lambda m: m and m[-1].header.stamp.to_sec() > 1)
            flown = len(odometry.messages)
            call("/gazebo/reset_simulation")

            def fallen(messages):  # once it was back at the start
                since = [m for m in messages[flown:] if m.header.stamp.to_sec() < 0.9]
                return [m for m in since if m.header.stamp.to_sec() > 0.2]

            message = fallen(odometry.wait(fallen))[0]
        self.assertLess(message.twist.twist.linear.z, -9 * message.header.stamp.to_sec())

    def test_a_state_that_is_set_is_published_and_flown_from(self):
        with flight("_paused:=true"), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            step(10)
            response = set_state(rotors=ROTORS)
            self.assertEqual((response.success, response.message), (True, ""))
            shown = odometry.wait_for_count(11)[-1]
            step(100)
            flown = odometry.wait_for_count(111)[-1]
        self.assertEqual(shown.header.stamp.to_nsec(), 10000000)
        self.assertEqual(shown.pose.pose.position, POSE.position)
        np.testing.assert_allclose(vector(shown.twist.twist.linear), [3, 2, -1], atol=1e-14)
        np.testing.assert_allclose(vector(shown.twist.twist.angular), [0.5, -0.25, 2], atol=1e-14)

        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
        simulation.step(10)
        state = simulation.state.copy()
        state.position = vector(POSE.position)
        state.orientation = [0.5, -0.5, 0.5, 0.5]
        state.linear_velocity = vector(TWIST.linear)
        state.angular_velocity = vector(TWIST.angular)
        state.rotor_velocity = ROTORS
        simulation.set_state(state)
        simulation.step(100)
        self.assertEqual(vector(flown.pose.pose.position), list(simulation.state.position))

    def test_a_wrong_state_is_refused_and_changes_nothing(self):
        with flight("_paused:=true"), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            for wrong, why in (
                ({"rotors": [1.0]}, "4 rotors"),
                ({"pose": Pose(Point(), Quaternion())}, "a quaternion of length 0. Give one of"),
                ({"pose": Pose(Point(), Quaternion(0, 0, 0, 2))}, "a quaternion of length 2."),
                ({"pose": Pose(Point(0, 0, float("nan")), POSE.orientation)}, "not a finite"),
            ):
                response = set_state(**wrong)
                self.assertFalse(response.success)
                self.assertIn(why, response.message)
            step(1)
            self.assertAlmostEqual(odometry.wait_for_count(1)[0].pose.pose.position.z, 10, 4)

    def test_a_flight_that_failed_goes_on_after_a_reset(self):
        with flight("_paused:=true"):
            self.assertTrue(set_state(rotors=[9e5, 9e5, 9e5, 9e5]).success)
            response = rospy.ServiceProxy("/quadcore/step", Step)(100)
            self.assertFalse(response.success)
            self.assertIn("the flight failed at t = ", response.message)
            call("/gazebo/reset_simulation")
            with Recording("/clock", Clock) as clock:  # what was not flown stays so
                clock.wait_for_publisher()
                rospy.sleep(0.2)
                self.assertEqual(clock.messages, [])
            step(10)

    def test_a_step_that_fails_says_so(self):
        with flight("_paused:=true"):
            self.assertTrue(set_state(rotors=[9e5, 9e5, 9e5, 9e5]).success)
            proxy = rospy.ServiceProxy("/quadcore/step", Step)
            for _ in range(2):  # the step that fails, and one asked for afterwards
                response = proxy(1)
                self.assertFalse(response.success)
                self.assertIn("the flight failed at t = ", response.message)

    def test_a_second_step_is_refused_and_holds_up_no_service(self):
        with flight("_paused:=true", "_lockstep:=true"):
            proxy = rospy.ServiceProxy("/quadcore/step", Step)
            messages = []
            calls = [
                threading.Thread(target=lambda: messages.append(proxy(10).message)) for _ in "ab"
            ]
            for each in calls:
                each.start()  # the first one waits for a command that nobody sends
            harness.wait_until(lambda: messages)
            self.assertIn("Another step is running", messages[0])
            call("/gazebo/pause_physics")
            for each in calls:
                each.join(harness.LONG)
            self.assertIn("Stopped 10 steps before the end.", messages[1])

    def test_a_command_that_is_not_flown_yet_outlives_a_set_state_but_no_reset(self):
        for jump, climbs in ((set_state, True), (reset, False)):
            topic = Recording("/odom", Odometry)
            with flight("_paused:=true"), commander() as send, topic as odometry:
                odometry.wait_for_publisher()
                send(HOVER)
                diagnostic("commands", lambda count: count == 1)
                jump(Pose(Point(0, 0, 20), Quaternion(0, 0, 0, 1)), Twist())
                step(500)
                flown = odometry.wait_for_count(501)[-1]
            self.assertEqual(flown.twist.twist.linear.z > -4, climbs)


def vector(v):
    return [v.x, v.y, v.z]


if __name__ == "__main__":
    harness.run("services", TestServices)
