#!/usr/bin/env python3
"""Topics of the node: names, types, frames, stamps, covariance, namespaces, clients."""

import unittest

import harness
import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import Point, Pose, Quaternion, Twist
from harness import HOVER, Process, Recording, commander, description, flight
from nav_msgs.msg import Odometry, Path
from quadcore.srv import SetState
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage

import quadcore as qc

# As the packages of Noetic have them.
PUBLISHED = {
    "/odom": ("nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"),
    "/ground_truth/odometry": ("nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"),
    "/tf": ("tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec"),
    "/tf_static": ("tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec"),
    "/clock": ("rosgraph_msgs/Clock", "a9c97c1d230cfc112e270351a944ee47"),
    "/joint_states": ("sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd"),
    "/path": ("nav_msgs/Path", "6227e2b7e9cce15051f669a5e197bbf7"),
    "/vehicle_markers": ("visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7"),
    "/diagnostics": ("diagnostic_msgs/DiagnosticArray", "60810da900de1dd6ddd437c3503511da"),
}
PLACES = [[0.2, 0], [0, -0.2], [-0.2, 0], [0, 0.2]]  # of the rotors in the frame (m)
COMMAND = ("std_msgs/Float64MultiArray", "4b7d974086d4060e7db4613a7e6c3ba4")


def stamps(messages):
    return [message.header.stamp.to_nsec() for message in messages]


def diagonal(covariance):
    return np.diag(np.reshape(covariance, (6, 6)))


def published():
    return dict(rosgraph.Master("/test").getPublishedTopics(""))


class TestTopics(unittest.TestCase):
    def test_names_types_and_md5sums(self):
        with flight():
            types = published()
            for topic, (name, md5sum) in PUBLISHED.items():
                self.assertEqual(types[topic], name)
                with Recording(topic, rospy.AnyMsg) as recording:
                    header = recording.wait_for_count(1)[0]._connection_header
                self.assertEqual((header["type"], header["md5sum"]), (name, md5sum))
            # rospy connects only a subscriber of the same type and md5sum.
            self.assertEqual((Float64MultiArray._type, Float64MultiArray._md5sum), COMMAND)
            with commander():
                pass

    def test_stamps_are_those_of_the_clock_and_nothing_is_lost(self):
        topics = Recording("/odom", Odometry), Recording("/clock", Clock)
        # So slow that the node keeps for 10 s what a busy machine does not let this process read.
        slow = ("_paused:=true", "_real_time_factor:=0.1")
        with flight(*slow), topics[0] as odometry, topics[1] as clock:
            odometry.wait_for_publisher()
            clock.wait_for_publisher()
            harness.call("/gazebo/unpause_physics")
            messages = odometry.wait_for_count(500)[:500]
            ticks = clock.wait_for_count(500)[:500]
        self.assertEqual(stamps(messages), [i * 1000000 for i in range(1, 501)])
        self.assertEqual([tick.clock.to_nsec() for tick in ticks], stamps(messages))

    def test_frames(self):
        with flight(), Recording("/odom", Odometry) as odometry, Recording("/tf", TFMessage) as tf:
            with Recording("/tf_static", TFMessage) as static:
                fixed = static.wait_for_count(1)[0].transforms[0]
            message = odometry.wait_for_publisher().wait_for_count(1)[0]
            tf.wait_for_publisher()
            transforms = [m.transforms[0] for m in tf.wait_for_count(300)]
            last = transforms[-1].header.stamp
            known = odometry.wait(lambda m: m[-1].header.stamp >= last)
            poses = {m.header.stamp: m.pose.pose for m in known}
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("world", "drone"))
        self.assertEqual((fixed.header.frame_id, fixed.child_frame_id), ("drone", "frame"))
        compared = 0
        for transform in transforms:
            self.assertEqual(transform.header.frame_id, "world")
            self.assertEqual(transform.child_frame_id, "drone")
            if transform.header.stamp in poses:
                pose = poses[transform.header.stamp]
                self.assertEqual(transform.transform.translation.z, pose.position.z)
                self.assertEqual(transform.transform.rotation, pose.orientation)
                compared += 1
        self.assertGreater(compared, 100)

    def test_covariance_is_that_of_the_noise_and_never_singular(self):
        noisy = {
            "positionNoise": "0.1",
            "orientationNoise": "0.02",
            "linearVelocityNoise": "0.3",
            "angularVelocityNoise": "0.4",
        }
        for tags, deviations in (({}, [1e-6] * 4), (noisy, [float(x) for x in noisy.values()])):
            with flight(urdf=description(**tags)), Recording("/odom", Odometry) as odometry:
                message = odometry.wait_for_count(1)[0]
            for covariance, pair in (
                (message.pose.covariance, deviations[:2]),
                (message.twist.covariance, deviations[2:]),
            ):
                expected = np.repeat(np.square(pair), 3)
                np.testing.assert_allclose(diagonal(covariance), expected, rtol=1e-14)
                self.assertEqual(np.count_nonzero(covariance), 6)

    def test_tags_of_the_odometry_plugin(self):
        tags = {"rate": "100", "twistFrame": "body", "publishTf": "false"}
        start = ("_roll:=1.5707963267948966", "_paused:=true")
        with flight(*start, urdf=description(**tags)):
            with Recording("/odom", Odometry) as odometry:
                odometry.wait_for_publisher()
                harness.step(100)
                messages = odometry.wait_for_count(10)
            self.assertNotIn("/quadcore", harness.publishers("/tf"))
        self.assertEqual(stamps(messages), [i * 10000000 for i in range(1, 11)])
        # It falls along its own -y.
        falling = messages[-1].twist.twist.linear
        self.assertAlmostEqual(falling.y, -0.98, delta=0.01)
        self.assertAlmostEqual(falling.z, 0, delta=1e-3)

    def test_joint_states_and_path(self):
        topics = Recording("/joint_states", JointState), Recording("/path", Path)
        with flight("_paused:=true", "_lockstep:=true"), topics[0] as joints, topics[1] as path:
            joints.wait_for_publisher()
            path.wait_for_connection()
            with commander() as send, Recording("/odom", Odometry, act=lambda _: send(HOVER)):
                harness.step(1000)
            states = joints.wait_for_count(50)
            paths = path.wait(lambda m: m and len(m[-1].poses) >= 10)
        self.assertEqual(states[0].name, ["rotor1", "rotor2", "rotor3", "rotor4"])
        self.assertEqual(stamps(states)[1] - stamps(states)[0], 20000000)
        np.testing.assert_allclose(states[-1].velocity, HOVER, rtol=1e-3)
        self.assertNotEqual(states[-1].position, states[-2].position)
        self.assertEqual(paths[-1].header.frame_id, "world")

    def test_who_subscribes_late_sees_a_paused_flight(self):
        kinds = {
            "/clock": Clock,
            "/odom": Odometry,
            "/ground_truth/odometry": Odometry,
            "/joint_states": JointState,
            "/tf": TFMessage,
        }
        with flight("_paused:=true"):
            harness.step(7)
            for _ in "ab":  # the second one, too
                for topic, kind in kinds.items():
                    with Recording(topic, kind) as recording:
                        message = recording.wait_for_count(1)[0]
                    if kind is TFMessage:
                        message = message.transforms[0]
                    stamp = message.clock if kind is Clock else message.header.stamp
                    seen = 0 if kind is JointState else 7000000  # those go out 50 times a second
                    self.assertEqual(stamp.to_nsec(), seen)

    def test_a_state_that_is_set_in_a_pause_is_in_tf_with_a_stamp_of_its_own(self):
        with flight("_paused:=true"), Recording("/tf", TFMessage) as tf:
            tf.wait_for_count(1)
            set_state = rospy.ServiceProxy("/quadcore/set_state", SetState)
            for height in (5, 6):
                set_state(Pose(Point(0, 0, height), Quaternion(w=1)), Twist(), [])
            last = tf.wait(lambda m: m[-1].transforms[0].transform.translation.z == 6)
            harness.step(1)
            known = tf.wait(lambda m: len(m) > len(last))
        times = [m.transforms[0].header.stamp.to_nsec() for m in known]
        self.assertEqual(times, sorted(set(times)))
        self.assertEqual(times[-1], 1_000_000)

    def test_the_rotors_frames_are_seen_late_too(self):
        with flight("_paused:=true", "_rotor_tf:=true"):
            set_state = rospy.ServiceProxy("/quadcore/set_state", SetState)
            turning = [100.0, -80.0, 60.0, -40.0]
            set_state(Pose(orientation=Quaternion(w=1)), Twist(), turning)
            harness.step(10)
            with Recording("/tf", TFMessage) as tf:
                rotors = tf.wait_for_count(1)[0].transforms[1:]
            with Recording("/joint_states", JointState) as joints:
                angles = np.array(joints.wait_for_count(1)[0].velocity) * 0.01
        self.assertEqual([t.child_frame_id for t in rotors], [f"propeller{i}" for i in range(1, 5)])
        for transform, place, angle in zip(rotors, PLACES, angles):
            self.assertEqual(transform.header.frame_id, "frame")
            p, q = transform.transform.translation, transform.transform.rotation
            np.testing.assert_allclose([p.x, p.y], place, atol=1e-12)
            self.assertAlmostEqual(2 * np.arctan2(q.z, q.w), angle, delta=0.2 * abs(angle))

    def test_the_truth_stands_beside_noisy_odometry(self):
        noise = {"positionNoise": "0.5", "linearVelocityNoise": "0.5"}
        topics = Recording("/odom", Odometry), Recording("/ground_truth/odometry", Odometry)
        start = flight("_paused:=true", urdf=description(**noise))
        with start, topics[0] as noisy, topics[1] as true, Recording("/tf", TFMessage) as tf:
            for recording in (noisy, true, tf):
                recording.wait_for_publisher()
            harness.step(100)
            noisy = noisy.wait_for_count(100)
            true = true.wait_for_count(100)
            transforms = [m.transforms[0] for m in tf.wait_for_count(100)]
        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
        heights = simulation.run(0.1).position[1:, 2]
        self.assertEqual([m.pose.pose.position.z for m in true], list(heights))
        self.assertEqual([t.transform.translation.z for t in transforms], list(heights))
        self.assertEqual(stamps(true), stamps(noisy))
        self.assertEqual(true[0].child_frame_id, noisy[0].child_frame_id)
        np.testing.assert_allclose(diagonal(true[0].pose.covariance), [1e-12] * 6)
        error = np.std([m.pose.pose.position.z for m in noisy] - heights)
        self.assertTrue(0.3 < error < 0.7, error)

    def test_a_namespace_holds_everything(self):
        with flight("_name:=blue", namespace="/uav1"):
            with Recording("/uav1/odom", Odometry) as odometry:
                message = odometry.wait_for_count(1)[0]
            with Recording("/tf", TFMessage) as tf:
                transform = tf.wait_for_count(1)[0].transforms[0]
            for part in (message, transform):
                self.assertEqual(part.header.frame_id, "world")
                self.assertEqual(part.child_frame_id, "uav1/drone")
            with commander("/uav1/blue/vel_cmd"):
                pass
            rospy.wait_for_service("/uav1/gazebo/pause_physics", harness.LONG)

    def test_a_roscpp_client_flies_a_robot_of_any_name(self):
        fast = ("_real_time_factor:=0", "_lockstep:=true")
        place = ("_reference/shape:=hover", "_reference/height:=12")
        topic = Recording("/odom", Odometry)
        mine = description().replace('name="quadrotor"', 'name="mine"', 1)
        controller = ("controller_node", "_law:=geometric", *place)
        with flight(*fast, urdf=mine), Process(*controller), topic as odometry:
            odometry.wait(lambda m: m and abs(m[-1].pose.pose.position.z - 12) < 0.01)


if __name__ == "__main__":
    harness.run("topics", TestTopics)
