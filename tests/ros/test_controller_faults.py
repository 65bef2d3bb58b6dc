#!/usr/bin/env python3
"""controller_node where something is missing, wrong, late or there twice."""

import tempfile
import unittest
from contextlib import ExitStack
from pathlib import Path

import harness
import numpy as np
import rospy
from harness import Process, Recording, description, flight, step, wait_until
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from std_msgs.msg import Float64MultiArray
from test_controller import CIRCLE, LOCKSTEP, controller, place

SLOW = ("_dt:=0.002", "_set:=drone_plugin.sim_slow=10 motorpid_plugin.sim_slow=10")
FAST = ("_lockstep:=true", "_real_time_factor:=0", "_lockstep_timeout:=30", "_engine:=eigen")


def odometry(t, x=0.0):
    """A vehicle that stands at (x, 0, 10)."""
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(t)
    message.pose.pose.position.x, message.pose.pose.position.z = x, 10
    message.pose.pose.orientation.w = 1
    return message


class TestControllerFaults(unittest.TestCase):
    def setUp(self):
        self.stack = ExitStack()
        self.addCleanup(self.stack.close)
        if rospy.has_param("/quadcore"):
            rospy.delete_param("/quadcore")
        rospy.set_param("/robot_description", description())

    def collect_warnings(self):
        """Collect the warnings of nodes from now on."""
        return self.stack.enter_context(Recording("/rosout", Log))

    def wait_for_warning(self, warnings, words):
        warnings.wait(lambda messages: any(words in m.msg for m in messages))

    def test_started_before_its_plant_it_believes_in_what_that_flies(self):
        folder = Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        logs = [folder / "before.csv", folder / "after.csv"]
        with controller(CIRCLE):
            wait_until(lambda: harness.publishers("/controller/reference"))
            with flight(*LOCKSTEP, *SLOW, "_x:=1.2", f"_log:={logs[0]}"):
                step(400)
        with flight(*LOCKSTEP, *SLOW, "_x:=1.2", f"_log:={logs[1]}"), controller(CIRCLE):
            step(400)
        self.assertEqual(len(logs[0].read_text().splitlines()), 402)
        self.assertEqual(logs[0].read_bytes(), logs[1].read_bytes())

    def test_it_flies_the_next_plant_as_the_first(self):
        odometry = self.stack.enter_context(Recording("/odom", Odometry))
        with controller({"shape": "hover", "height": 10.2}):
            for options in ((), SLOW):
                odometry.messages.clear()
                with flight(*FAST, *options):
                    odometry.wait(
                        lambda m: (
                            m
                            and m[-1].header.stamp.to_sec() > 3
                            and np.allclose(place(m[-1]), [0, 0, 10.2], atol=1e-3)
                        )
                    )

    def test_odometry_that_is_not_finite_is_refused_and_the_last_command_kept(self):
        warnings = self.collect_warnings()
        node = controller({"shape": "hover", "height": 10.2}, rate=1000)
        commands = Recording("/quadrotor/vel_cmd", Float64MultiArray)
        publisher = rospy.Publisher("/odom", Odometry, queue_size=10)
        self.addCleanup(publisher.unregister)
        with node, commands:
            wait_until(lambda: publisher.get_num_connections() > 0)
            commands.wait_for_connection()
            flat = odometry(0.003)
            flat.pose.pose.orientation.w = 0
            sent = [odometry(0.001), odometry(0.002, float("nan")), flat, odometry(0.004, 0.1)]
            for count, message in enumerate(sent, 1):
                publisher.publish(message)
                commands.wait_for_count(count)
            speeds = [np.array(m.data) for m in commands.messages]
            self.wait_for_warning(warnings, "/odom: contains numbers that are not finite")
        np.testing.assert_array_equal(speeds[1], speeds[0])
        np.testing.assert_array_equal(speeds[2], speeds[0])
        self.assertTrue(np.isfinite(speeds[3]).all())
        self.assertGreater(np.abs(speeds[3] - speeds[0]).max(), 1)

    def test_two_commanders_of_one_vehicle_are_reported(self):
        warnings = self.collect_warnings()
        second = Process("controller_node", "__name:=second", "_law:=geometric")
        with flight("_engine:=eigen", "_real_time_factor:=0.2"), controller(), second:
            self.wait_for_warning(
                warnings, "/quadrotor/vel_cmd: both /controller and /second send commands"
            )

    def test_without_odometry_it_says_so(self):
        warnings = self.collect_warnings()
        elsewhere = Process("controller_node", "odom:=elsewhere", "_law:=geometric")
        with flight("_paused:=true"), elsewhere:
            self.wait_for_warning(warnings, "No node publishes odometry on /elsewhere")

    def test_without_a_plant_it_says_so(self):
        warnings = self.collect_warnings()
        with controller():
            self.wait_for_warning(warnings, "No node receives commands on /quadrotor/vel_cmd")

    def test_odometry_that_comes_seldom_is_answered_each_time(self):
        topic = self.stack.enter_context(Recording("/odom", Odometry))
        with flight(*FAST, "_set:=odometry.rate=100"), controller("hover"):
            message = topic.wait(lambda m: m and m[-1].header.stamp.to_sec() > 6)[-1]
        np.testing.assert_allclose(place(message), [0, 0, 10], atol=1e-3)

    def test_vehicles_in_namespaces_have_controllers_of_their_own(self):
        topics, urdf = [], description()
        for space, height in (("/uav1", 10.3), ("/uav2", 9.8)):
            name = f"_name:={space[1:]}"
            self.stack.enter_context(flight(*FAST, name, namespace=space, urdf=urdf))
            own = (f"__ns:={space}", "_law:=geometric", "_reference/shape:=hover")
            node = Process("controller_node", *own, f"_reference/height:={height}")
            self.stack.enter_context(node)
            topic = self.stack.enter_context(Recording(f"{space}/odom", Odometry))
            topics.append((topic, height))
        for topic, height in topics:
            goal = [0, 0, height]
            topic.wait(lambda m, goal=goal: m and np.allclose(place(m[-1]), goal, atol=1e-3))
            self.assertTrue(topic.messages[-1].child_frame_id.startswith("uav"))


if __name__ == "__main__":
    harness.run("controller_faults", TestControllerFaults)
