#!/usr/bin/env python3
"""The launch files, at the root and in a namespace, with another model, world and engine."""

import unittest

import harness
import rospy
from harness import Recording
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState


def settled(altitude):
    """Whether the vehicle has come to rest there."""

    def holds(messages):
        if not messages:
            return False
        pose, twist = messages[-1].pose.pose, messages[-1].twist.twist
        return abs(pose.position.z - altitude) < 0.02 and abs(twist.linear.z) < 0.02

    return holds


class TestLaunch(unittest.TestCase):
    def test_the_first_launch_flies(self):
        with Recording("/odom", Odometry) as odometry:
            odometry.wait(settled(1), 20)
        self.assertTrue(rospy.get_param("/use_sim_time"))
        self.assertIn("<robot", rospy.get_param("/robot_description"))

    def test_a_namespace_with_other_arguments_flies(self):
        with Recording("/uav1/odom", Odometry) as odometry:
            odometry.wait(settled(1), 20)
        with Recording("/uav1/joint_states", JointState) as joints:
            self.assertAlmostEqual(joints.wait_for_count(1)[0].velocity[0], 471, delta=1)
        self.assertEqual(rospy.get_param("/uav1/quadcore/engine"), "ode")


if __name__ == "__main__":
    harness.run("launch", TestLaunch)
