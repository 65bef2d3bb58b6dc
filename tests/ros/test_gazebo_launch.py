#!/usr/bin/env python3
"""A launch file that was written for gazebo_ros flies."""

import math
import subprocess
import unittest

import harness
import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import GetPhysicsProperties
from harness import Process, Recording
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage


class TestGazeboLaunch(unittest.TestCase):
    def test_a_model_is_spawned_where_it_was_asked_for_and_waits(self):
        with Recording("/gazebo/model_states", ModelStates) as states:
            message = states.wait_for_count(1)[0]
        self.assertEqual(message.name, ["ground_plane", "quad"])
        pose = message.pose[1]
        place = [pose.position.x, pose.position.y, pose.position.z]
        self.assertEqual(place, [1, -2, 3])
        self.assertAlmostEqual(pose.orientation.z, math.sin(0.25), places=12)
        with Recording("/tf", TFMessage) as tf:  # for rviz
            frames = {t.child_frame_id for t in tf.wait_for_count(1)[0].transforms}
        self.assertEqual(frames, {"drone", *(f"propeller{i}" for i in range(1, 5))})
        rospy.wait_for_service("/gazebo/get_physics_properties", harness.LONG)
        physics = rospy.ServiceProxy("/gazebo/get_physics_properties", GetPhysicsProperties)
        self.assertTrue(physics().pause)
        with Recording("/clock", Clock) as clock:
            harness.call("/gazebo/unpause_physics")
            clock.wait(lambda m: m and m[-1].clock.to_sec() > 0.1)
        with harness.commander("/quad/vel_cmd") as send, Recording("/odom", Odometry) as odometry:
            send(harness.HOVER)
            odometry.wait(lambda m: m and m[-1].twist.twist.linear.z > 0)

    def test_what_gazebo_ros_knows_and_this_does_not_is_refused(self):
        spawn = [harness.executable("spawn_model"), "-model", "quad"]
        refused = "is not supported: "
        for words, why in (
            (["-sdf", "-file", "a.sdf"], "-sdf " + refused),
            (["-urdf"], "-param -file"),
            (["-param", "robot_description"], "required: -urdf"),
            (["-urdf", "-database", "coke_can"], "-database " + refused),
            (["-urdf", "-stdin"], "-stdin " + refused),
        ):
            ended = subprocess.run([*spawn, *words], stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(ended.returncode, 2)
            self.assertIn("spawn_model: error:", ended.stderr)
            self.assertIn(why, ended.stderr)

    def test_a_second_model_waits_for_the_first_and_begins_with_turned_rotors(self):
        second = ("-urdf", "-param", "robot_description", "-model", "second", "-b")
        turned = ("-J", "rotor1", "0.5", "-J", "rotor3", "-0.25", "-robot_namespace", "second")
        world = ("-gazebo_namespace", "/gazebo")
        joint_states = Recording("/second/joint_states", JointState)
        spawned = Process("spawn_model", *second, *turned, *world, "-wait", "quad")
        with spawned, joint_states as joints:
            angles = joints.wait_for_count(1)[0].position
        for angle, given in zip(angles, (0.5, 0, -0.25, 0)):
            self.assertAlmostEqual(angle, given, places=12)
        with Process("spawn_model", *second, "-wait", "nobody", "-timeout", "0.2") as lonely:
            status, error = lonely.result()
        self.assertEqual(status, 1)
        self.assertIn("error: -wait: model 'nobody' does not exist after 0.2 s.", error)


if __name__ == "__main__":
    harness.run("gazebo_launch", TestGazeboLaunch)
