#!/usr/bin/env python3
"""Nodes of hector_quadrotor's tutorials find its actions, topics and service."""

import unittest

import actionlib
import harness
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from harness import Recording
from hector_uav_msgs.msg import (
    LandingAction,
    LandingGoal,
    PoseAction,
    PoseGoal,
    TakeoffAction,
    TakeoffGoal,
)
from hector_uav_msgs.srv import EnableMotors
from nav_msgs.msg import Odometry

STATE = "/ground_truth/state"


def send(name, action, goal):
    """Send a goal, and return how the action ended."""
    client = actionlib.SimpleActionClient(name, action)
    harness.wait_until(lambda: client.wait_for_server(rospy.Duration(1)))
    client.send_goal(goal)
    harness.wait_until(lambda: client.get_state() > GoalStatus.ACTIVE)
    return client.get_state()


def speed(recording, axis):
    return getattr(recording.messages[-1].twist.twist.linear, axis)


class TestHector(unittest.TestCase):
    def test_a_flight_by_actions_and_velocities(self):
        rospy.wait_for_service("/enable_motors", harness.LONG)
        self.assertTrue(rospy.ServiceProxy("/enable_motors", EnableMotors)(True).success)
        self.assertFalse(rospy.ServiceProxy("/enable_motors", EnableMotors)(False).success)
        with Recording(STATE, Odometry) as state:
            first = state.wait_for_count(1)[0]
            self.assertEqual((first.header.frame_id, first.child_frame_id), ("world", "base_link"))
            done = send("/action/takeoff", TakeoffAction, TakeoffGoal())
            self.assertEqual(done, GoalStatus.SUCCEEDED)
            self.assertAlmostEqual(state.messages[-1].pose.pose.position.z, 0.3, delta=0.06)

            goal = PoseGoal(PoseStamped())
            goal.target_pose.header.frame_id = "world"
            goal.target_pose.pose.position.x, goal.target_pose.pose.position.z = 1, 1
            goal.target_pose.pose.orientation.w = 1
            self.assertEqual(send("/action/pose", PoseAction, goal), GoalStatus.SUCCEEDED)
            self.assertAlmostEqual(state.messages[-1].pose.pose.position.x, 1, delta=0.06)

            plain = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
            stamped = rospy.Publisher("/command/twist", TwistStamped, queue_size=1)
            twist, stamped_twist = Twist(), TwistStamped()
            twist.linear.x, stamped_twist.twist.linear.y = 0.5, -0.5
            for publisher, message, axis, wanted in (
                (plain, twist, "x", 0.5),
                (stamped, stamped_twist, "y", -0.5),
            ):

                def repeat(publisher=publisher, message=message, axis=axis, wanted=wanted):
                    publisher.publish(message)
                    rospy.rostime.wallsleep(0.02)
                    return abs(speed(state, axis) - wanted) < 0.05

                harness.wait_until(repeat)

            done = send("/action/landing", LandingAction, LandingGoal())
            self.assertEqual(done, GoalStatus.SUCCEEDED)
            self.assertLess(state.messages[-1].pose.pose.position.z, 0.1)


if __name__ == "__main__":
    harness.run("hector", TestHector)
