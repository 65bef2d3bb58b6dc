#!/usr/bin/env python3
"""A client that knows RotorS' topics alone flies firefly through way points."""

import unittest

import harness
import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import (
    PointStamped,
    Pose,
    PoseWithCovarianceStamped,
    TransformStamped,
)
from harness import Recording
from mav_msgs.msg import Actuators
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Float32
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

WAY_POINTS = np.array([[0, 0, 1], [1, 0, 1.5], [1, -1, 1.2], [0, 0, 1]], dtype=float)
TOPICS = {
    "motor_speed": Actuators,
    "motor_speed/3": Float32,
    "imu": Imu,
    "ground_truth/imu": Imu,
    "ground_truth/odometry": Odometry,
    "ground_truth/pose": Pose,
    "ground_truth/pose_with_covariance": PoseWithCovarianceStamped,
    "ground_truth/position": PointStamped,
    "ground_truth/transform": TransformStamped,
    "odometry_sensor1/odometry": Odometry,
    "gazebo/command/motor_speed": Actuators,
    "joint_states": JointState,
}


def rotation(q):
    """Matrix of a quaternion."""
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def vector(v):
    return np.array([v.x, v.y, v.z])


def published():
    """Type of each topic that somebody publishes."""
    return dict(rosgraph.Master("/rotors").getPublishedTopics(""))


class Client:
    """A controller of its own (Lee, Leok, McClamroch, 2010) on RotorS' topics alone."""

    MASS, GRAVITY, ARM = 1.56779, 9.81, 0.215
    INERTIA = np.diag([0.0347563, 0.0458929, 0.0977])
    THRUST, MOMENT = 8.54858e-06, 0.016
    ANGLES = np.radians([30, 90, 150, 210, 270, 330])
    SENSES = np.array([1, -1, 1, -1, 1, -1])

    def __init__(self, space):
        self.goal = WAY_POINTS[0]
        allocation = np.array(
            [
                self.ARM * np.sin(self.ANGLES),
                -self.ARM * np.cos(self.ANGLES),
                -self.MOMENT * self.SENSES,
                np.ones(6),
            ]
        )
        self.inverse = np.linalg.pinv(self.THRUST * allocation)
        self.publisher = rospy.Publisher(
            f"{space}/command/motor_speed", Actuators, queue_size=1, tcp_nodelay=True
        )

    def answer(self, odometry):
        """Send the speeds that answer an odometry."""
        pose, twist = odometry.pose.pose, odometry.twist.twist
        R = rotation(pose.orientation)
        e_x = vector(pose.position) - self.goal
        e_v = R @ vector(twist.linear)
        force = -6 * e_x - 4.7 * e_v + self.MASS * np.array([0, 0, self.GRAVITY])
        z = force / np.linalg.norm(force)
        y = np.cross(z, [1, 0, 0])
        y /= np.linalg.norm(y)
        wanted = np.column_stack([np.cross(y, z), y, z])
        difference = wanted.T @ R - R.T @ wanted
        e_R = 0.5 * np.array([difference[2, 1], difference[0, 2], difference[1, 0]])
        torque = -np.array([3, 3, 0.15]) * e_R - np.array([0.52, 0.52, 0.18]) * vector(
            twist.angular
        )
        squares = self.inverse @ np.append(torque, force @ R[:, 2])
        message = Actuators(angular_velocities=np.sqrt(np.maximum(squares, 0)))
        message.header.stamp = odometry.header.stamp
        self.publisher.publish(message)


class TestRotors(unittest.TestCase):
    def test_a_client_written_for_rotors_flies_firefly_through_way_points(self):
        client = Client("/firefly")
        wanted = {f"/firefly/{name}": kind._type for name, kind in TOPICS.items()}
        harness.wait_until(lambda: wanted.items() <= published().items())
        odometry = Recording("/firefly/odometry_sensor1/odometry", Odometry, act=client.answer)
        rospy.wait_for_service("/gazebo/unpause_physics", harness.LONG)
        rospy.ServiceProxy("/gazebo/unpause_physics", Empty)()

        def at_rest(messages):
            if not messages:
                return False
            pose, twist = messages[-1].pose.pose, messages[-1].twist.twist
            off = np.linalg.norm(vector(pose.position) - client.goal)
            return off < 0.05 and np.linalg.norm(vector(twist.linear)) < 0.05

        for client.goal in WAY_POINTS:
            odometry.wait(at_rest)
        # Only now, because this process would read some 10,000 messages per second of flight.
        last = {}
        for name, kind in TOPICS.items():
            with Recording(f"/firefly/{name}", kind) as seen:
                last[name] = seen.wait_for_count(1)[-1]
        truth = last["ground_truth/odometry"]
        self.assertEqual(truth.header.frame_id, "world")
        self.assertEqual(truth.child_frame_id, "firefly/base_link")
        self.assertEqual(
            last["odometry_sensor1/odometry"].child_frame_id, "firefly/odometry_sensor1"
        )
        self.assertEqual(last["imu"].header.frame_id, "firefly/imu_link")
        self.assertEqual(len(last["motor_speed"].angular_velocities), 6)
        hover = np.sqrt(client.MASS * client.GRAVITY / 6 / client.THRUST)
        self.assertAlmostEqual(abs(last["motor_speed/3"].data) * 10, hover, delta=0.05 * hover)
        self.assertAlmostEqual(last["ground_truth/position"].point.z, 1, delta=0.1)
        self.assertAlmostEqual(last["ground_truth/transform"].transform.translation.z, 1, delta=0.1)
        frames = {"firefly/odometry_sensor1", "firefly/drone"}
        with Recording("/tf", TFMessage) as tf:
            tf.wait(lambda m: frames <= {t.child_frame_id for each in m for t in each.transforms})


if __name__ == "__main__":
    harness.run("rotors", TestRotors)
