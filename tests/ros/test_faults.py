#!/usr/bin/env python3
"""What goes wrong: commands, subscribers, signals, models."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client
from functools import partial

import harness
import numpy as np
import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from harness import HOVER, Recording, commander, description, diagnostic, flight, outcome, step
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

NAN, INFINITY = float("nan"), float("inf")


class TestFaults(unittest.TestCase):
    def test_wrong_commands_are_refused_and_the_last_good_one_kept(self):
        wrong = [[400.0] * 3, [], [400.0] * 5, [NAN, 1, 1, 1], [1, 1, 1, -INFINITY], [1e300] * 4]
        topic = Recording("/joint_states", JointState)
        with flight(), commander() as send, topic as joints:
            send(HOVER)
            for speeds in wrong:
                send(speeds)
            diagnostic("rejected commands", lambda count: count == 6)
            self.assertEqual(diagnostic("commands"), 1)
            joints.wait(lambda m: np.allclose(m[-1].velocity, HOVER, rtol=0.01))

    def test_each_kind_of_wrong_command_is_reported(self):
        with flight() as node, commander() as send:
            for speeds in ([1.0], [NAN] * 4, [1e300] * 4):
                send(speeds)
            diagnostic("rejected commands", lambda count: count == 3)
            node.end()
        for kind in ("the command has 1 rotor speeds", "not a finite number", "beyond 1e+06 rad/s"):
            self.assertEqual(node.error.count(kind), 1, kind)

    def test_bad_commands_are_reported_once_a_second(self):
        with flight() as node, commander() as send:
            begun = time.monotonic()
            for i in range(300):
                send([1.0] * (i % 3))
            diagnostic("rejected commands", lambda count: count == 300)
            seconds = time.monotonic() - begun
            node.end()
        # Of each of the three kinds one in each second that has begun.
        self.assertLessEqual(node.error.count("the command has"), 3 * (seconds + 1))

    def test_a_model_without_motors_takes_no_commands(self):
        urdf = re.sub(
            r"<plugin\b[^>]*libmotorpid_plugin.so.*?</plugin>", "", description(), flags=re.DOTALL
        )
        with flight(urdf=urdf) as node, commander() as send:
            send(HOVER)
            diagnostic("rejected commands", lambda count: count == 1)
            node.end()
        self.assertIn("The model takes no commands. Add libmotorpid_plugin.so.", node.error)

    def test_a_log_that_cannot_be_written_to_the_end(self):
        with flight("_log:=/dev/full") as node:
            diagnostic("steps", lambda count: count > 100)
            node.end()
        self.assertEqual(node.process.returncode, 2)
        cut = "/dev/full: the log is incomplete: No space left on device"
        self.assertEqual(node.error.splitlines()[-1], f"error: {cut}")
        self.assertEqual(node.error.count(cut), 2)  # at once and at the end

    def test_a_log_that_cannot_be_closed_in_time_is_no_success(self):
        with tempfile.TemporaryDirectory() as folder:
            stuck = os.path.join(folder, "log.csv")
            os.mkfifo(stuck)
            reader = os.open(stuck, os.O_RDONLY | os.O_NONBLOCK)  # and never reads
            with flight(f"_log:={stuck}", "_real_time_factor:=0") as node:
                steps = [-1]

                def stands(count):
                    steps.append(count)
                    return steps[-1] == steps[-2]

                diagnostic("steps", stands)
                node.end()
            os.close(reader)
        self.assertEqual(node.process.returncode, 2)
        self.assertIn("The flight did not end in time. Its log may be incomplete", node.error)

    def test_lockstep_without_a_controller_says_what_it_waits_for(self):
        with flight("_lockstep:=true") as node, Recording("/diagnostics", DiagnosticArray) as says:
            waits = "waiting for a command on /quadrotor/vel_cmd"
            says.wait(lambda m: m and m[-1].status[0].message == waits)
            says.wait_for_count(len(says.messages) + 2)
            node.end()
        self.assertEqual(node.error.count(waits), 1)

    def test_commands_that_stop_time_out(self):
        urdf = description().replace("<kp>", "<commandTimeout>0.3</commandTimeout><kp>")
        topic = Recording("/joint_states", JointState)
        with flight(urdf=urdf), commander() as send, topic as joints:
            send(HOVER)
            joints.wait(lambda m: any(joint.velocity[0] > 400 for joint in m))
            joints.wait(lambda m: abs(m[-1].velocity[0]) < 10)

    def test_a_subscriber_that_is_stuck_holds_up_nobody(self):
        with flight("_paused:=true"), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            stuck = subprocess.Popen(
                [sys.executable, "-c", STUCK], stdout=subprocess.PIPE, text=True
            )
            try:
                stuck.stdout.readline()  # it has got a message, so it is connected
                stuck.send_signal(signal.SIGSTOP)
                # In pieces of which a node keeps all for who is slow, so that none is lost.
                for flown in range(500, 8001, 500):
                    step(500)
                    odometry.wait_for_count(flown)
            finally:
                stuck.kill()
                stuck.communicate()
        stamps = np.array([m.header.stamp.to_nsec() for m in odometry.messages])
        self.assertTrue(np.all(np.diff(stamps) == 1000000))

    def test_signals_end_it_within_a_second(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for arguments in ((), ("_paused:=true",), ("_real_time_factor:=0.0001",)):
                harness.ends_within_a_second(partial(flight, *arguments), number)

    def test_rosnode_kill_ends_it_well(self):
        for _ in range(4):
            with flight("_paused:=true") as node:
                uri = rosgraph.Master("/test").lookupNode("/quadcore")
                xmlrpc.client.ServerProxy(uri).shutdown("/test", "as rosnode kill does")
                status, error = node.result()
            self.assertEqual(status, 0)
            self.assertNotIn("new ROS master", error)

    def test_a_bad_model_is_one_line(self):
        good = description()
        line = good[: good.index("<kp>")].count("\n") + 1
        for bad, message in (
            (good.replace("<kp>", "<kq>").replace("</kp>", "</kq>"), f"robot_description:{line}: "),
            ("<robot", "robot_description:1: "),
            ("", "robot_description"),
        ):
            rospy.set_param("robot_description", bad)
            status, error = outcome()
            self.assertEqual(status, 2)
            self.assertEqual(len(error.splitlines()), 1, error)
            self.assertTrue(error.startswith(f"error: {message}"), error)
        rospy.delete_param("robot_description")
        status, error = outcome()
        self.assertEqual(status, 2)
        self.assertIn("error: robot_description: is not on the parameter server", error)

    def test_bad_parameters(self):
        rospy.set_param("robot_description", description())
        for argument, message in (
            (
                "_lockstp:=true",
                "parameter ~lockstp: does not exist. Did you mean 'lockstep'? It stays on the "
                "parameter server until you run: rosparam delete /quadcore/lockstp",
            ),
            ("_paused:=1", "parameter ~paused: give true or false"),
            ("_z:=high", "parameter ~z: give a number"),
            ("_real_time_factor:=-1", "parameter ~real_time_factor: give a number >= 0"),
            ("_seed:=1e30", "parameter ~seed: give a whole number from 0 to 9007199254740992"),
            ("_dt:=-1", "parameter ~dt: give a step from 1e-9 to 0.1 s"),
            ("_engine:=gazebo12", "engine 'gazebo12' does not exist. Did you mean 'gazebo11'?"),
            ("_world:=/none.world", "/none.world: the file cannot be read"),
            ("_log:=/none/log.csv", "/none/log.csv: cannot be written"),
            ("_clock:=both", "parameter ~clock: give auto, lead or follow"),
            ("_name:=a-b", "model name 'a-b' cannot name a topic"),
        ):
            status, error = outcome(argument)
            rospy.delete_param("quadcore")
            self.assertEqual(status, 2)
            self.assertEqual(len(error.splitlines()), 1, error)
            self.assertIn(f"error: {message}", error)


# A subscriber that says when it is connected.
STUCK = """
import rospy
from nav_msgs.msg import Odometry
rospy.init_node("stuck", disable_rostime=True)
subscriber = rospy.Subscriber("/odom", Odometry, lambda message: None)
while subscriber.get_num_connections() == 0:
    rospy.sleep(0.01)
print("connected", flush=True)
rospy.spin()
"""


if __name__ == "__main__":
    harness.run("faults", TestFaults)
