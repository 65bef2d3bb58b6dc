#!/usr/bin/env python3
"""The launch files, at the root and in a namespace, with another model, world and engine."""

import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import harness
import numpy as np
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
            odometry.wait(settled(1))
        self.assertTrue(rospy.get_param("/use_sim_time"))
        self.assertIn("<robot", rospy.get_param("/robot_description"))

    def test_a_namespace_with_other_arguments_flies(self):
        with Recording("/uav1/odom", Odometry) as odometry:
            odometry.wait(settled(1))
        with Recording("/uav1/joint_states", JointState) as joints:
            joints.wait(lambda m: m and abs(m[-1].velocity[0] - 471) < 1)
        self.assertEqual(rospy.get_param("/uav1/quadcore/engine"), "ode")

    def test_the_model_can_be_changed_by_arguments(self):
        changes = ("name:=blue", "set:=odometry.rate=50 odometry.twistFrame=body", "drag:=none")
        start = ("roll:=0.5", "pitch:=-0.5", "z:=50", "dt:=0.002", "engine:=eigen", "paused:=true")
        launch = subprocess.Popen(
            ["roslaunch", "quadcore", "quadrotor.launch", "gui:=false", *changes, *start],
            env={**os.environ, "ROS_NAMESPACE": "changed"},
            stdout=subprocess.DEVNULL,
        )
        try:
            topic = Recording("/changed/odom", Odometry)
            with harness.commander("/changed/blue/vel_cmd"), topic as odometry:
                odometry.wait_for_count(1)  # before it falls
                harness.call("/changed/gazebo/unpause_physics")
                messages = odometry.wait_for_count(22)[1:]  # from when it has joined the clock
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(harness.LONG)
        times = [m.header.stamp.to_nsec() for m in messages[1:]]
        self.assertEqual({b - a for a, b in zip(times, times[1:])}, {20000000})
        # Without drag a fall is a fall, seen along the axes of a vehicle that leans.
        v, t = messages[-1].twist.twist.linear, times[-1] * 1e-9
        self.assertGreater(abs(v.y), 0.1 * abs(v.z))
        falls = np.linalg.norm([v.x, v.y, v.z]) - np.linalg.norm(
            [getattr(messages[1].twist.twist.linear, axis) for axis in "xyz"]
        )
        self.assertAlmostEqual(falls, 9.8 * (t - times[0] * 1e-9), delta=1e-6)

    def test_relative_paths_begin_where_roslaunch_was_called(self):
        worlds = Path(rospkg.RosPack().get_path("quadcore")) / "worlds"
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "my.urdf").write_text(harness.description())
            (Path(folder) / "my.world").write_text((worlds / "empty.world").read_text())
            paths = ["name:=relative", "model:=my.urdf", "world:=my.world", "log:=my.csv"]
            launch = subprocess.Popen(
                ["roslaunch", "quadcore", "quadrotor.launch", "gui:=false", *paths],
                env={**os.environ, "ROS_NAMESPACE": "relative"},
                cwd=folder,
                stdout=subprocess.DEVNULL,
            )
            try:
                with Recording("/relative/odom", Odometry) as odometry:
                    odometry.wait_for_count(200)
            finally:
                launch.send_signal(signal.SIGINT)
                launch.wait(harness.LONG)
            self.assertGreater(len((Path(folder) / "my.csv").read_text().splitlines()), 100)

    def test_arguments_of_xacro_are_given_without_an_error_of_ros(self):
        arguments = ("gui:=false", "name:=plain", "xacro_args:=sim_slow=1")
        launch = subprocess.Popen(
            ["roslaunch", "quadcore", "quadrotor.launch", *arguments],
            env={**os.environ, "ROS_NAMESPACE": "plain"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        try:
            with Recording("/plain/odom", Odometry) as odometry:
                odometry.wait_for_count(1)
        finally:
            launch.send_signal(signal.SIGINT)
            printed, _ = launch.communicate(timeout=harness.LONG)
        self.assertNotIn("ERROR", printed)
        self.assertNotIn("Invalid", printed)
        urdf = rospy.get_param("/plain/robot_description")
        self.assertIn("<sim_slow>1<", urdf)


if __name__ == "__main__":
    harness.run("launch", TestLaunch)
