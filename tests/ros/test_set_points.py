#!/usr/bin/env python3
"""What controller_node is asked for on topics: places, paths, velocities, attitudes, rates."""

import unittest
from contextlib import ExitStack

import harness
import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, Quaternion, Transform, Twist, Vector3
from harness import Recording, flight, step, wait_until
from nav_msgs.msg import Odometry
from quadcore.msg import AttitudeThrust, RateThrust
from rosgraph_msgs.msg import Log
from test_controller import controller, place, vector
from trajectory_msgs.msg import MultiDOFJointTrajectory, MultiDOFJointTrajectoryPoint

FAST = (
    "_paused:=true",
    "_lockstep:=true",
    "_real_time_factor:=0",
    "_lockstep_timeout:=30",
    "_engine:=eigen",
)
WEIGHT = 1.04 * 9.8  # N


def turned(roll=0.0, pitch=0.0, yaw=0.0):
    """A quaternion of fixed-axes angles."""
    (sr, cr), (sp, cp), (sy, cy) = ((np.sin(a / 2), np.cos(a / 2)) for a in (roll, pitch, yaw))
    return Quaternion(
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def yaw_of(message):
    q = message.pose.pose.orientation
    return 2 * np.arctan2(q.z, q.w)


def time_of(message):
    return message.header.stamp.to_sec()


def pose(x, y, z, yaw=0.0, frame="world"):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
    message.pose.orientation = turned(yaw=yaw)
    return message


def point(t, xyz, yaw=0.0, velocity=None, acceleration=None):
    message = MultiDOFJointTrajectoryPoint(time_from_start=rospy.Duration(t))
    message.transforms = [Transform(Vector3(*xyz), turned(yaw=yaw))]
    for twists, linear in (
        (message.velocities, velocity),
        (message.accelerations, acceleration),
    ):
        if linear is not None:
            twists.append(Twist(linear=Vector3(*linear)))
    return message


class TestSetPoints(unittest.TestCase):
    """A vehicle that waits at (0, 0, 10) for what it is asked for."""

    def setUp(self):
        stack = ExitStack()
        self.addCleanup(stack.close)
        self.node = stack.enter_context(flight(*FAST))
        self.controller = stack.enter_context(controller())
        self.odometry = stack.enter_context(Recording("/odom", Odometry))
        self.reference = stack.enter_context(Recording("/controller/reference", Odometry))
        self.odometry.wait_for_connection()
        self.reference.wait_for_connection()
        self.publishers = {}

    def ask(self, topic, message):
        """Send what is asked for, once somebody listens."""
        if topic not in self.publishers:
            publisher = rospy.Publisher(topic, type(message), queue_size=10)
            self.addCleanup(publisher.unregister)
            self.publishers[topic] = publisher
        wait_until(lambda: self.publishers[topic].get_num_connections() > 0)
        self.publishers[topic].publish(message)

    def settled(self, until, recording=None):
        """The first message of which it holds.

        Flies on in small pieces, so that a node has no more on its way than it keeps for one who
        is slow: none is lost.
        """
        recording = recording or self.odometry
        looked, pieces = 0, 0
        while True:
            messages = list(recording.messages)
            for message in messages[looked:]:
                if until(message):
                    return message
            looked = len(messages)
            self.assertLess(pieces, 240, "a minute flown in vain")
            flown = step(250)
            pieces += 1
            self.odometry.wait(lambda m, flown=flown: m and m[-1].header.stamp == flown)

    def test_a_pose_is_a_hover_there(self):
        # Whatever its stamp says: of an old flight, or of the clock on the wall.
        for x, yaw, stamp in ((0.5, 0.4, rospy.Time(0, 1)), (-0.3, 3.0, rospy.Time(1700000000))):
            asked = pose(x, 0.2, 10.3, yaw)
            asked.header.stamp = stamp
            self.ask("/command/pose", asked)
            goal = [x, 0.2, 10.3]
            message = self.settled(
                lambda m, goal=goal, yaw=yaw: (
                    np.allclose(place(m), goal, atol=1e-3) and abs(yaw_of(m) - yaw) < 1e-3
                )
            )
            self.assertLess(np.linalg.norm(vector(message.twist.twist.linear)), 0.05)

    def test_a_trajectory_is_flown_through_its_points_at_their_times(self):
        points = [
            point(2, (1, 0.5, 10.5), 2.0),
            point(4, (2, 0, 11), -2.5, velocity=(0.5, -0.3, 0.1), acceleration=(0, 0.2, 0)),
            point(7, (1, -1, 10), -2.0),
        ]
        self.settled(lambda m: time_of(m) > 4)  # rotors that stood still at the start turn
        self.ask("/command/trajectory", MultiDOFJointTrajectory(points=points))
        begun = self.settled(lambda m: place(m)[0] != 0, self.reference)
        for recording in (self.odometry, self.reference):  # either may come late
            self.settled(lambda m: time_of(m) > time_of(begun) + 8, recording)
        wanted = list(self.reference.messages)
        now = {m.header.stamp: m for m in self.odometry.messages}
        # The first of the path is the last that still stands where it began.
        start = time_of(begun) - 0.001

        def at(t):
            return min(wanted, key=lambda m: abs(time_of(m) - start - t))

        for p in points:
            message = at(p.time_from_start.to_sec())
            goal = vector(p.transforms[0].translation)
            np.testing.assert_allclose(place(message), goal, atol=2e-3)
            np.testing.assert_allclose(place(now[message.header.stamp]), goal, atol=2e-2)
        on_the_way = at(4)
        np.testing.assert_allclose(
            vector(on_the_way.twist.twist.linear), [0.5, -0.3, 0.1], atol=2e-3
        )
        # Yaw takes the short way over half a turn: from 2.0 on to 2 pi - 2.5.
        turning = [m.twist.twist.angular.z for m in wanted if 2.2 < time_of(m) - start < 3.8]
        self.assertGreater(min(turning), 0)
        final = self.settled(lambda m: time_of(m) > start + 8, self.reference)
        np.testing.assert_array_equal(place(final), [1, -1, 10])
        self.assertEqual(vector(final.twist.twist.linear).tolist(), [0, 0, 0])

    def test_a_lone_point_is_held_with_what_is_given_of_it(self):
        held = point(0, (0.4, 0, 10), velocity=(0.1, 0, 0))
        self.ask("/command/trajectory", MultiDOFJointTrajectory(points=[held]))
        message = self.settled(lambda m: place(m)[0] == 0.4, self.reference)
        self.assertEqual(vector(message.twist.twist.linear).tolist(), [0.1, 0, 0])

    def test_a_velocity_goes_by_the_heading_and_ends_in_a_hover(self):
        self.ask("/command/pose", pose(0, 0, 10, np.pi / 2))
        self.settled(lambda m: abs(yaw_of(m) - np.pi / 2) < 1e-3)
        self.ask("/command/velocity", Twist(linear=Vector3(0.8, 0, 0.2)))
        moving = self.settled(lambda m: m.twist.twist.linear.z != 0, self.reference)
        np.testing.assert_allclose(vector(moving.twist.twist.linear), [0, 0.8, 0.2], atol=1e-12)
        final = self.settled(
            lambda m: time_of(m) > time_of(moving) and m.twist.twist.linear.z == 0, self.reference
        )
        # For half a second, as nothing followed.
        self.assertAlmostEqual(time_of(final) - time_of(moving), 0.5, delta=2e-3)
        np.testing.assert_allclose(place(final), [0, 0.4, 10.1], atol=1e-9)
        self.settled(lambda m: np.allclose(place(m), place(final), atol=1e-3))

    def test_a_turning_velocity_flies_a_circle(self):
        self.ask("/command/velocity", Twist(linear=Vector3(1, 0, 0), angular=Vector3(0, 0, 2)))
        moving = self.settled(lambda m: m.twist.twist.angular.z != 0, self.reference)
        final = self.settled(
            lambda m: time_of(m) > time_of(moving) and m.twist.twist.angular.z == 0, self.reference
        )
        # A circle of radius 1/2, a turn of 1 rad.
        goal = [np.sin(1) / 2, (1 - np.cos(1)) / 2, 10]
        np.testing.assert_allclose(place(final), goal, atol=1e-9)
        self.assertAlmostEqual(yaw_of(final), 1, delta=1e-9)

    def test_an_attitude_is_reached_and_held(self):
        message = AttitudeThrust(attitude=turned(0.2, -0.1, 0.3), thrust=Vector3(0, 0, WEIGHT))
        self.ask("/command/attitude_thrust", message)
        q = message.attitude
        wanted = [q.x, q.y, q.z, q.w]

        def is_there(m):
            q = m.pose.pose.orientation
            return np.allclose([q.x, q.y, q.z, q.w], wanted, atol=2e-3)

        reached = self.settled(is_there)
        later = self.settled(lambda m: time_of(m) > time_of(reached) + 2)
        self.assertTrue(is_there(later))
        # It leans to where it drifts, and no reference is published.
        self.assertLess(later.pose.pose.position.y, reached.pose.pose.position.y)
        self.assertFalse([m for m in self.reference.messages if time_of(m) >= time_of(reached)])

    def test_rates_are_reached_and_held(self):
        rates = Vector3(0.0, 0.0, 0.7)
        self.ask("/command/rate_thrust", RateThrust(None, rates, Vector3(0, 0, WEIGHT)))

        def is_there(m):
            return np.allclose(vector(m.twist.twist.angular), [0, 0, 0.7], atol=2e-3)

        reached = self.settled(is_there)
        self.assertTrue(is_there(self.settled(lambda m: time_of(m) > time_of(reached) + 1)))
        # And back to a place.
        self.ask("/command/pose", pose(0.2, 0, 10))
        self.settled(lambda m: np.allclose(place(m), [0.2, 0, 10], atol=2e-3))

    def test_what_makes_no_sense_is_refused_and_reported(self):
        two = point(1, (0, 0, 10))
        two.transforms *= 2
        late = [point(2, (0, 0, 10)), point(1, (0, 0, 10))]
        upright = turned()
        sideways = Vector3(1, 0, 5)
        cases = [
            ("/command/pose", pose(0, 0, 10, frame="map"), "frame_id is 'map'"),
            ("/command/pose", PoseStamped(), "is not a quaternion of length 1"),
            ("/command/pose", pose(float("nan"), 0, 10), "position contains a number"),
            ("/command/trajectory", MultiDOFJointTrajectory(), "the path has no points"),
            ("/command/trajectory", MultiDOFJointTrajectory(points=[two]), "Give one transform"),
            ("/command/trajectory", MultiDOFJointTrajectory(points=late), "not later than"),
            ("/command/velocity", Twist(angular=Vector3(1, 0, 0)), "angular is not about z"),
            ("/command/attitude_thrust", AttitudeThrust(None, upright, sideways), "not along z"),
            (
                "/command/rate_thrust",
                RateThrust(None, Vector3(0, 0, float("inf")), Vector3()),
                "angular_rates contains a number",
            ),
        ]
        self.ask("/command/pose", pose(0, 0, 10.2))
        self.settled(lambda m: time_of(m) > 8)
        with Recording("/rosout", Log) as rosout:
            for topic, message, says in cases:

                def is_reported(topic=topic, message=message, says=says):
                    self.ask(topic, message)
                    return any(
                        m.msg.startswith(f"{topic}: refused: ") and says in m.msg
                        for m in list(rosout.messages)
                    )

                wait_until(is_reported)
        # The last good one stays.
        now = self.odometry.messages[-1].header.stamp.to_sec()
        message = self.settled(lambda m: time_of(m) > now + 1)
        self.assertAlmostEqual(place(message)[2], 10.2, delta=1e-3)


if __name__ == "__main__":
    harness.run("set_points", TestSetPoints)
