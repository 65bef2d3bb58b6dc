#!/usr/bin/env python3
"""controller_node flies as the plugin does, and says what it follows and how far off it is."""

import unittest
from contextlib import contextmanager

import harness
import numpy as np
import rospy
from geometry_msgs.msg import Vector3Stamped
from harness import Process, Recording, call, description, flight, step
from nav_msgs.msg import Odometry

STEPS = 1500
LOCKSTEP = (
    "_paused:=true",
    "_lockstep:=true",
    "_real_time_factor:=0",
    "_lockstep_timeout:=30",  # a busy machine is no fault
)
NOISY = {
    "positionNoise": "0.001",
    "orientationNoise": "0.002",
    "linearVelocityNoise": "0.01",
    "angularVelocityNoise": "0.02",
}
CIRCLE = {"shape": "circle", "radius": 1.2, "rate": 1.3, "yaw_rate": 0.2}


def element(name, tags):
    """A plugin of a URDF."""
    inside = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return f'<plugin name="{name}" filename="lib{name}_plugin.so">{inside}</plugin>'


def with_controller(urdf, tags, reference):
    """The vehicle, flown by plugins."""
    plugins = element("controller", tags) + element("reference", reference)
    return urdf.replace("</robot>", f"<gazebo>{plugins}</gazebo></robot>")


@contextmanager
def controller(reference=None, urdf=None, **parameters):
    """A controller_node with these private parameters."""
    if rospy.has_param("/controller"):
        rospy.delete_param("/controller")
    if reference:
        parameters["reference"] = reference
    if urdf:
        rospy.set_param("/robot_description", urdf)
    rospy.set_param("/controller/law", "geometric")
    for name, value in parameters.items():
        rospy.set_param(f"/controller/{name}", value)
    with Process("controller_node") as node:
        yield node


def vector(v):
    return np.array([v.x, v.y, v.z])


def place(message):
    return vector(message.pose.pose.position)


class TestController(unittest.TestCase):
    def setUp(self):
        self.folder = harness.folder_of(self)

    def test_as_plugin_and_as_node_it_is_one_flight_byte_for_byte(self):
        cases = [
            ("gazebo11", {"law": "geometric", "kp_xy": 7.5}),
            ("ode", {"law": "pid", "rate": 300, "scale": 0.8}),
            ("eigen", {"law": "indi", "rate": 170, "delay": 0.0131}),
            ("eigen", {"law": "lqr", "delay": 0.005, "lead": "false"}),
            ("gazebo11", {"law": "pd_compensated"}),
            ("ode", {"law": "pd", "rate": 2000}),
            ("eigen", {"law": "pid_thesis"}),
        ]
        start = ("_x:=1", "_roll:=0.3", "_seed:=7")
        for engine, tags in cases:
            with self.subTest(engine=engine, **tags):
                plugin, node = self.folder / "plugin.csv", self.folder / "node.csv"
                bare = description(**NOISY)
                options = (*start, f"_engine:={engine}")
                urdf = with_controller(bare, tags, CIRCLE)
                with flight("_paused:=true", *options, f"_log:={plugin}", urdf=urdf):
                    step(STEPS)
                answered = flight(*LOCKSTEP, *options, f"_log:={node}", urdf=bare)
                with answered, controller(CIRCLE, **tags):
                    step(STEPS)
                self.assertEqual(len(node.read_text().splitlines()), STEPS + 2)
                self.assertEqual(node.read_bytes(), plugin.read_bytes())

    def test_it_says_what_it_follows_and_how_far_off_it_is(self):
        topics = (
            Recording("/odom", Odometry),
            Recording("/controller/reference", Odometry),
            Recording("/controller/error", Vector3Stamped),
        )
        with flight(*LOCKSTEP, "_x:=1.2"), controller(CIRCLE), topics[0], topics[1], topics[2]:
            for recording in topics:
                recording.wait_for_connection()
            step(500)
            odometry, reference, error = (topic.wait_for_count(501) for topic in topics)
        for now, wanted, off in zip(odometry, reference, error):
            t = now.header.stamp.to_sec()
            self.assertEqual(wanted.header.stamp, now.header.stamp)
            self.assertEqual(off.header.stamp, now.header.stamp)
            on_circle = [1.2 * np.cos(1.3 * t), 1.2 * np.sin(1.3 * t), 10]
            np.testing.assert_allclose(place(wanted), on_circle, atol=1e-12)
            along = [-1.56 * np.sin(1.3 * t), 1.56 * np.cos(1.3 * t), 0]
            np.testing.assert_allclose(vector(wanted.twist.twist.linear), along, atol=1e-12)
            np.testing.assert_array_equal(vector(off.vector), place(wanted) - place(now))
        q = reference[-1].pose.pose.orientation
        self.assertAlmostEqual(2 * np.arctan2(q.z, q.w), 0.1, delta=1e-9)
        self.assertEqual(reference[-1].twist.twist.angular.z, 0.2)
        self.assertEqual(
            (reference[-1].header.frame_id, reference[-1].child_frame_id), ("world", "drone")
        )

    def test_after_a_reset_it_begins_anew(self):
        topic = Recording("/odom", Odometry)
        with flight(*LOCKSTEP, "_x:=1"), controller("hover"), topic as odometry:
            odometry.wait_for_connection()
            step(300)
            first = [place(m) for m in odometry.wait_for_count(301)]
            call("/gazebo/reset_simulation")
            step(300)
            second = [place(m) for m in odometry.wait_for_count(602)[301:]]
        np.testing.assert_array_equal(first, second)

    def test_without_a_reference_it_stays_where_it_is(self):
        fast = ("_real_time_factor:=0", "_lockstep:=true", "_x:=0.7", "_z:=3", "_yaw:=0.5")
        with flight(*fast), controller(), Recording("/odom", Odometry) as odometry:
            message = odometry.wait(lambda m: m and m[-1].header.stamp.to_sec() > 5)[-1]
        np.testing.assert_allclose(place(message), [0.7, 0, 3], atol=1e-3)
        q = message.pose.pose.orientation
        self.assertAlmostEqual(2 * np.arctan2(q.z, q.w), 0.5, delta=1e-3)

    def test_it_believes_in_what_the_node_of_the_plant_flies(self):
        fast = ("_real_time_factor:=0", "_lockstep:=true", "_engine:=eigen")
        slow = "_set:=drone_plugin.sim_slow=10 motorpid_plugin.sim_slow=10"
        with flight(*fast, slow), controller("hover"), Recording("/odom", Odometry) as odometry:
            message = odometry.wait(lambda m: m and m[-1].header.stamp.to_sec() > 5)[-1]
        np.testing.assert_allclose(place(message), [0, 0, 10], atol=1e-3)

    def test_what_cannot_be_flown_is_refused_in_one_line(self):
        flown = with_controller(description(), {"law": "pd"}, CIRCLE)
        cases = [
            ({"lew": "pd"}, "parameter ~lew: does not exist. Did you mean 'law'?"),
            ({"law": "geometrik"}, "parameter ~law: plugin 'controller_node': <law> 'geometrik'"),
            ({"kp_xy": -1}, "parameter ~kp_xy: plugin 'controller_node': <kp_xy> '-1' is out of"),
            ({"kp_xy": "much"}, "<kp_xy> 'much' is not a finite number"),
            ({"kp_rp": 1}, "controller 'geometric' has no parameter 'kp_rp'"),
            ({"reference": "spirale"}, "parameter ~reference: plugin"),
            (
                {"reference": {"shape": "circle", "radios": 1}},
                "parameter ~reference/radios: does not exist",
            ),
            ({"urdf": description(rate="100"), "rate": 200}, "~rate: odometry arrives 100 times a"),
            ({"urdf": flown}, "vel_cmd"),
            ({"urdf": description(twistFrame="body")}, "twistFrame"),
        ]
        if rospy.has_param("/quadcore"):
            rospy.delete_param("/quadcore")
        for parameters, says in cases:
            parameters = {"urdf": description(), **parameters}
            with self.subTest(says), controller(**parameters) as node:
                status, error = node.result()
                self.assertEqual((status, len(error.splitlines())), (2, 1), error)
                self.assertIn(says, error)
        rospy.delete_param("/robot_description")
        with controller() as node:
            self.assertIn("robot_description: is not on the parameter server", node.result()[1])


if __name__ == "__main__":
    harness.run("controllers", TestController)
