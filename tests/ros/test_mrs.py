#!/usr/bin/env python3
"""What example nodes of mrs_multirotor_simulator send, with the changes of docs/migrating.md."""

import unittest
from contextlib import contextmanager

import harness
import numpy as np
import rospy
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import PoseStamped, Quaternion, Twist
from harness import Recording
from nav_msgs.msg import Odometry
from quadcore.msg import AttitudeThrust, RateThrust
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage

WEIGHT = 1.04 * 9.8  # N
PERIOD = 0.1  # s, of the examples


def heading_of(message):
    q = message.pose.pose.orientation
    return np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def turned(heading):
    return Quaternion(0, 0, np.sin(heading / 2), np.cos(heading / 2))


def numbers(vector):
    return np.array([vector.x, vector.y, vector.z])


@contextmanager
def sending(topic, kind, make):
    """Publish a message ten times a second, as the examples do."""
    publisher = rospy.Publisher(topic, kind, queue_size=1)
    timer = rospy.Timer(rospy.Duration(PERIOD), lambda _: publisher.publish(make()))
    try:
        yield
    finally:
        timer.shutdown()
        timer.join()
        publisher.unregister()


class TestMrs(unittest.TestCase):
    def test_commands_of_a_position_and_of_a_velocity(self):
        with Recording("/uav1/odom", Odometry) as odometry:
            first = odometry.wait_for_count(1)[0]
            frames = first.header.frame_id, first.child_frame_id
            self.assertEqual(frames, ("simulator_origin", "uav1/fcu"))

            def goto():  # position_cmd
                message = PoseStamped()
                message.pose.position.z, message.pose.orientation = 5, turned(1.0)
                return message

            def has_come(messages):
                pose = messages[-1].pose.pose
                return np.linalg.norm(numbers(pose.position) - [0, 0, 5]) < 0.05

            with sending("/uav1/command/pose", PoseStamped, goto):
                odometry.wait(lambda m: has_come(m) and abs(heading_of(m[-1]) - 1) < 0.02)

            def move():  # velocity_hdg_rate_cmd (1, 0.5, 0.2) in the world, turned to the heading
                message, heading = Twist(), heading_of(odometry.messages[-1])
                c, s = np.cos(heading), np.sin(heading)
                message.linear.x, message.linear.y = c * 1 + s * 0.5, -s * 1 + c * 0.5
                message.linear.z = 0.2
                return message

            def moves(messages):
                q = messages[-1].pose.pose.orientation
                body = numbers(messages[-1].twist.twist.linear)  # twistFrame body, as there
                axis = np.array([q.x, q.y, q.z])
                world = body + 2 * np.cross(axis, np.cross(axis, body) + q.w * body)
                return np.linalg.norm(world - [1, 0.5, 0.2]) < 0.1

            with sending("/uav1/command/velocity", Twist, move):
                odometry.wait(moves)
            # Without messages, the vehicle hovers, as there after its input_timeout.
            odometry.wait(lambda m: np.linalg.norm(numbers(m[-1].twist.twist.linear)) < 0.05)

            def level():  # attitude_cmd, with the thrust in N in the place of a throttle
                message = AttitudeThrust(attitude=turned(heading_of(odometry.messages[-1])))
                message.thrust.z = 1.1 * WEIGHT
                return message

            def climbs(messages):
                return messages[-1].twist.twist.linear.z > 1

            with sending("/uav1/command/attitude_thrust", AttitudeThrust, level):
                odometry.wait(climbs)

            def spin():  # attitude_rate_cmd
                message = RateThrust()
                message.angular_rates.z, message.thrust.z = 0.7, WEIGHT
                return message

            with sending("/uav1/command/rate_thrust", RateThrust, spin):
                odometry.wait(lambda m: abs(m[-1].twist.twist.angular.z - 0.7) < 0.05)

    def test_commands_of_actuators_end_after_a_timeout(self):
        with Recording("/uav2/joint_states", JointState) as joints:
            joints.wait_for_count(1)
            speeds = [475.0, -475.0, 475.0, -475.0]

            def spread(message):
                return max(abs(a - b) for a, b in zip(message.velocity, speeds))

            with sending("/uav2/uav2/vel_cmd", Float64MultiArray, lambda: speeds_message(speeds)):
                joints.wait(lambda m: spread(m[-1]) < 5)
            joints.wait(lambda m: max(map(abs, m[-1].velocity)) < 50)

    def test_pace_and_frames(self):
        leader = next(
            n for n in ("/uav1", "/uav2") if harness.publishers("/clock") == [f"{n}/quadcore"]
        )
        sliders = Client(f"{leader}/quadcore", timeout=harness.LONG)
        factor = sliders.update_configuration({"real_time_factor": 0.5})["real_time_factor"]
        self.assertEqual(factor, 0.5)
        sliders.update_configuration({"real_time_factor": 1})
        sliders.close()
        with Recording("/tf", TFMessage) as tf:
            wanted = {("simulator_origin", f"{name}/fcu") for name in ("uav1", "uav2")}

            def known(messages):
                pairs = {
                    (t.header.frame_id, t.child_frame_id) for m in messages for t in m.transforms
                }
                return wanted <= pairs

            tf.wait(known)


def speeds_message(speeds):
    return Float64MultiArray(data=speeds)


if __name__ == "__main__":
    harness.run("mrs", TestMrs)
