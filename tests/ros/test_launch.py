#!/usr/bin/env python3
"""The launch files, at the root and in a namespace, with another model, world and engine."""

import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import harness
import rospkg
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

    def test_relative_paths_begin_where_roslaunch_was_called(self):
        worlds = Path(rospkg.RosPack().get_path("quadcore")) / "worlds"
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "my.urdf").write_text(harness.description())
            (Path(folder) / "my.world").write_text((worlds / "empty.world").read_text())
            paths = ["model:=my.urdf", "world:=my.world", "log:=my.csv"]
            launch = subprocess.Popen(
                ["roslaunch", "quadcore", "quadrotor.launch", "gui:=false", *paths],
                env={**os.environ, "ROS_NAMESPACE": "relative"},
                cwd=folder,
                stdout=subprocess.DEVNULL,
            )
            try:
                with Recording("/relative/odom", Odometry) as odometry:
                    odometry.wait(lambda m: m and m[-1].header.stamp.to_sec() > 0.1)
            finally:
                launch.send_signal(signal.SIGINT)
                launch.wait(20)
            self.assertGreater(len((Path(folder) / "my.csv").read_text().splitlines()), 100)


if __name__ == "__main__":
    harness.run("launch", TestLaunch)
