#!/usr/bin/env python3
"""Masters that are missing, mute, die, hang, and come back."""

import contextlib
import os
import random
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import harness
import rosgraph
from harness import (
    Process,
    description,
    outcome,
)


def free_port():
    """A port that nobody has, and that the system gives to nobody who asks for any."""
    while True:
        port = random.randrange(20000, 32000)
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("localhost", port))
            return port


@contextlib.contextmanager
def master(port):
    """A ROS master of its own."""
    command = ["rosmaster", "--core", "-p", str(port)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        harness.wait_until(lambda: answers(port))
        yield process
    finally:
        process.kill()
        process.wait()


def answers(port):
    with socket.socket() as probe:
        return probe.connect_ex(("localhost", port)) == 0


def list_names(port, kind):
    """Names that a master has: of topics that are published (kind 0), or of services (kind 2)."""
    state = rosgraph.Master("/test", f"http://localhost:{port}").getSystemState()
    return [name for name, _ in state[kind]]


class TestMasters(unittest.TestCase):
    def shell(self, port, *command):
        """Output of a ROS command under another master."""
        environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}
        return subprocess.run(
            command,
            env=environment,
            stdout=subprocess.PIPE,
            timeout=harness.LONG,
            text=True,
            check=True,
        ).stdout

    def wait_until_it_flies(self, port):
        """Wait for a node that is set up as a whole: before that it sends no diagnostics."""
        self.shell(port, "rostopic", "echo", "-n1", "/diagnostics")

    def odometry(self, port):
        """Time (s) and altitude (m) that a new subscriber receives."""
        lines = self.shell(port, "rostopic", "echo", "-n1", "-p", "/odom").splitlines()
        message = dict(zip(lines[0].split(","), lines[-1].split(",")))
        return float(message["field.header.stamp"]) / 1e9, float(
            message["field.pose.pose.position.z"]
        )

    def flies_at(self, altitude, port):
        """Whether the vehicle flies there for a second and more.

        In lockstep time hardly goes on without a controller, and no load of the machine makes a
        command late.
        """
        harness.wait_until(lambda: "/odom" in list_names(port, 0))
        begun, _ = self.odometry(port)
        harness.wait_until(lambda: self.odometry(port)[0] > begun + 1)
        return abs(self.odometry(port)[1] - altitude) < 0.1

    def test_no_master(self):
        uri = f"http://localhost:{free_port()}"
        status, error = outcome(ROS_MASTER_URI=uri)
        self.assertEqual(status, 2)
        self.assertIn(f"error: no ROS master at {uri}. Start roscore", error)

    def test_a_mute_or_wrong_master(self):
        with socket.socket() as mute:
            mute.bind(("localhost", 0))
            mute.listen()
            uri = f"http://localhost:{mute.getsockname()[1]}"
            for wrong, message in (
                (uri, f"no answer within 5 s from a ROS master at {uri}. Start roscore"),
                ("nowhere", "ROS_MASTER_URI: 'nowhere' is not an address. Write http://HOST:PORT"),
                ("", "ROS_MASTER_URI: '' is not an address"),
            ):
                status, error = outcome(ROS_MASTER_URI=wrong)
                self.assertEqual(status, 2)
                self.assertEqual(len(error.splitlines()), 1, error)
                self.assertIn(f"error: {message}", error)

    def test_a_master_that_dies_and_comes_back(self):
        port = free_port()
        uri = f"http://localhost:{port}"
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as model:
            model.write(description())
            model.flush()
            with contextlib.ExitStack() as stack:
                with master(port):
                    start = (f"_model:={model.name}", "_z:=2", "_lockstep:=true")
                    node = Process("quadcore_node", *start, ROS_MASTER_URI=uri)
                    stack.enter_context(node)
                    harness.wait_until(lambda: "/quadcore/step" in list_names(port, 2))
                    hover = ("_law:=geometric", "_reference/shape:=hover", "_reference/height:=2")
                    controller = Process("controller_node", *hover, ROS_MASTER_URI=uri)
                    stack.enter_context(controller)
                    harness.wait_until(lambda: self.flies_at(2, port))
                time.sleep(1.5)
                self.assertIsNone(node.process.poll())
                with master(port):
                    harness.wait_until(lambda: "/quadcore/step" in list_names(port, 2))
                    kind = self.shell(port, "rostopic", "type", "/quadrotor/vel_cmd")
                    self.assertEqual(kind.strip(), "std_msgs/Float64MultiArray")
                    # Both old connections stand: the vehicle hovers at its set point.
                    self.assertTrue(self.flies_at(2, port))
                    self.shell(port, "rosservice", "call", "/gazebo/pause_physics")
                    node.end()

    def test_a_new_master_is_given_the_parameters_of_the_old_one(self):
        port = free_port()
        uri = f"http://localhost:{port}"
        text = description()
        with contextlib.ExitStack() as stack:
            with master(port):
                rosgraph.Master("/test", uri).setParam("/robot_description", text)
                node = Process("quadcore_node", "_paused:=true", ROS_MASTER_URI=uri)
                stack.enter_context(node)
                self.wait_until_it_flies(port)
            with master(port):
                again = rosgraph.Master("/test", uri)
                harness.wait_until(lambda: again.hasParam("/use_sim_time"))
                self.assertIs(again.getParam("/use_sim_time"), True)
                self.assertEqual(again.getParam("/robot_description"), text)

    @contextlib.contextmanager
    def under_a_master_that_hangs(self, *arguments):
        model = harness.folder_of(self) / "model.urdf"
        model.write_text(description())
        port = free_port()
        uri = f"http://localhost:{port}"
        command = ("quadcore_node", f"_model:={model}", *arguments)
        with master(port) as hanging, Process(*command, ROS_MASTER_URI=uri) as node:
            self.wait_until_it_flies(port)
            hanging.send_signal(signal.SIGSTOP)
            time.sleep(1.5)
            yield node

    def test_signals_end_it_even_if_the_master_hangs(self):
        harness.ends_within_a_second(self.under_a_master_that_hangs, signal.SIGTERM)

    def test_a_log_that_is_cut_is_no_success_though_the_master_hangs(self):
        with self.under_a_master_that_hangs("_log:=/dev/full") as node:
            node.end()
        self.assertEqual(node.process.returncode, 2)
        cut = "error: /dev/full: the log is incomplete: No space left on device"
        self.assertEqual(node.error.splitlines()[-1], cut)


if __name__ == "__main__":
    harness.run("masters", TestMasters)
