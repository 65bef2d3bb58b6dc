#!/usr/bin/env python3
"""RotorS' six vehicles hover on one clock."""

import unittest

import harness
import numpy as np
import rospy
from gazebo_msgs.msg import ModelState, ModelStates
from gazebo_msgs.srv import GetModelState, GetWorldProperties, SetModelState
from harness import Recording
from mav_msgs.msg import Actuators
from nav_msgs.msg import Odometry

ROTORS = {"firefly": 6, "hummingbird": 4, "pelican": 4, "iris": 4, "ardrone": 4, "neo11": 6}


def hovers(messages):
    """Whether a vehicle has come to rest at 1 m."""
    if not messages:
        return False
    pose, twist = messages[-1].pose.pose, messages[-1].twist.twist
    return abs(pose.position.z - 1) < 0.05 and abs(twist.linear.z) < 0.02


class TestRotorsHover(unittest.TestCase):
    def test_six_vehicles_take_off_and_hover_on_one_clock(self):
        for i, (name, rotors) in enumerate(ROTORS.items()):
            with Recording(f"/{name}/ground_truth/odometry", Odometry) as flight:
                last = flight.wait(hovers, 5 * harness.LONG)[-1]
            self.assertAlmostEqual(last.pose.pose.position.y, i, delta=0.1)
            self.assertEqual(last.child_frame_id, f"{name}/base_link")
            with Recording(f"/{name}/motor_speed", Actuators) as speeds:
                velocities = speeds.wait_for_count(1)[-1].angular_velocities
            self.assertEqual(len(velocities), rotors)
        self.assertEqual(len(harness.publishers("/clock")), 1)

        # To clients of gazebo_ros they are models of one world.
        with Recording("/gazebo/model_states", ModelStates) as states:
            known = states.wait(lambda m: m and len(m[-1].name) == 7)[-1]
        self.assertEqual(set(known.name), {"ground_plane", *ROTORS})
        world = rospy.ServiceProxy("/gazebo/get_world_properties", GetWorldProperties)()
        self.assertEqual(set(world.model_names), {"ground_plane", *ROTORS})
        get = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)
        change = rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)
        harness.call("/gazebo/pause_physics")
        for i, name in enumerate(ROTORS):
            self.assertAlmostEqual(get(name, "").pose.position.y, i, delta=0.1)
            moved = ModelState(model_name=name)
            moved.pose.position.z = 20
            self.assertTrue(change(moved).success)
            # One that follows may have had ticks to fly that came before the pause.
            self.assertAlmostEqual(get(name, "").pose.position.z, 20, delta=0.05)
        self.assertFalse(get("solo", "").success)
        harness.call("/gazebo/reset_world")
        for i, name in enumerate(ROTORS):
            place = get(name, "").pose.position
            np.testing.assert_allclose([place.x, place.y, place.z], [0, i, 0.1], atol=0.05)


if __name__ == "__main__":
    harness.run("rotors_hover", TestRotorsHover)
