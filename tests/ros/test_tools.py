#!/usr/bin/env python3
"""Frames of REP 105, the rate of /clock, sliders, and files of rviz, rqt and PlotJuggler."""

import ast
import json
import os
import re
import subprocess
import tempfile
import unittest
import urllib.request
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import harness
import rospkg
import rospy
import yaml
from dynamic_reconfigure import DynamicReconfigureCallbackException
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Vector3Stamped
from harness import Process, Recording, description, flight, outcome, step
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

CONFIG = Path(rospkg.RosPack().get_path("quadcore")) / "config"
PAUSED = "_paused:=true"
REP_105 = ("_map_frame:=map", "_world_frame:=odom", "_vehicle_frame:=base_link")


def transforms(topic):
    """Parent and child of each transform in the first message of a topic."""
    with Recording(topic, TFMessage) as recording:
        first = recording.wait_for_count(1)[0]
    return {(t.header.frame_id, t.child_frame_id) for t in first.transforms}


def odometry_frames(topic="/odom"):
    with Recording(topic, Odometry) as recording:
        message = recording.wait_for_count(1)[0]
    return message.header.frame_id, message.child_frame_id


def written_for_rviz(namespace=""):
    """Settings that rviz would read, by a program of this name in its place."""
    with tempfile.TemporaryDirectory() as folder:
        rosrun = Path(folder) / "rosrun"
        rosrun.write_text('#!/bin/sh\ncat "$4"\n')
        rosrun.chmod(0o755)
        environment = {"PATH": f"{folder}:{os.environ['PATH']}", "ROS_NAMESPACE": namespace}
        shown = subprocess.run(
            [harness.executable("show_in_rviz.py"), str(CONFIG / "quadrotor.rviz")],
            env={**os.environ, **environment},
            stdout=subprocess.PIPE,
            check=True,
        )
    return yaml.safe_load(shown.stdout)["Visualization Manager"]


class TestTools(unittest.TestCase):
    def test_frames_are_those_of_rep_105(self):
        with flight(PAUSED, *REP_105):
            for topic in ("/odom", "/ground_truth/odometry"):
                self.assertEqual(odometry_frames(topic), ("odom", "base_link"))
            self.assertEqual(transforms("/tf"), {("odom", "base_link")})
            self.assertEqual(transforms("/tf_static"), {("map", "odom"), ("base_link", "frame")})
            rviz = written_for_rviz()
        self.assertEqual(rviz["Global Options"]["Fixed Frame"], "map")
        self.assertEqual(rviz["Views"]["Current"]["Target Frame"], "base_link")

    def test_frames_of_one_vehicle_begin_with_its_namespace(self):
        with flight(PAUSED, *REP_105, namespace="/uav1"):
            self.assertEqual(odometry_frames("/uav1/odom"), ("uav1/odom", "uav1/base_link"))
            self.assertIn(("map", "uav1/odom"), transforms("/tf_static"))
            rviz = written_for_rviz("uav1")
        self.assertEqual(rviz["Views"]["Current"]["Target Frame"], "uav1/base_link")
        vehicle = next(d for d in rviz["Displays"] if d["Class"] == "rviz/RobotModel")
        self.assertEqual(vehicle["TF Prefix"], "uav1")

    def test_tags_name_the_frames_and_parameters_override_them(self):
        tags = "<frame_id>earth</frame_id><child_frame_id>body</child_frame_id>"
        begin = 'filename="libodometry_plugin.so">'
        urdf = description().replace(begin, begin + tags)
        with flight(PAUSED, urdf=urdf):
            self.assertEqual(odometry_frames(), ("earth", "body"))
            self.assertEqual(transforms("/tf"), {("earth", "body")})
        with flight(PAUSED, "_world_frame:=site", urdf=urdf):
            self.assertEqual(odometry_frames(), ("site", "body"))

    def test_frames_that_make_no_tree_are_refused(self):
        for given in ("_vehicle_frame:=world", "_world_frame:=propeller1", "_vehicle_frame:=/a"):
            rospy.set_param("/robot_description", description())
            if rospy.has_param("/quadcore"):
                rospy.delete_param("/quadcore")
            status, error = outcome(given)
            self.assertEqual(status, 2)
            self.assertRegex(error, "error: parameter ~(world|vehicle)_frame: ")
        rospy.delete_param("/quadcore")

    def test_the_clock_has_the_given_rate(self):
        with flight(PAUSED, "_pub_clock_frequency:=100"):
            with Recording("/clock", Clock) as clock:
                clock.wait_for_publisher()
                step(50)
                step(45)
                times = [m.clock.to_nsec() for m in clock.wait_for_count(9)]
            with Recording("/clock", Clock) as newcomer:  # receives the present time
                present = newcomer.wait_for_count(1)[0].clock.to_nsec()
        self.assertEqual(times, [10_000_000 * i for i in range(1, 10)])
        self.assertEqual(present, 95_000_000)

    def test_sliders_pause_and_set_the_pace(self):
        with flight():
            sliders = Client("/quadcore", timeout=harness.LONG)
            self.assertEqual(sliders.get_configuration()["paused"], False)
            sliders.update_configuration({"paused": True, "real_time_factor": 0.5})
            harness.wait_for_status("paused")
            harness.call("/gazebo/unpause_physics")  # the slider follows
            harness.wait_until(lambda: not sliders.get_configuration()["paused"])
            self.assertEqual(sliders.get_configuration()["real_time_factor"], 0.5)
            sliders.close()

    def set_wind(self, *arguments, urdf):
        """Air velocity of a paused flight, before and after the slider has set its y."""
        with flight(PAUSED, *arguments, urdf=urdf) as node:
            sliders = Client("/quadcore", timeout=harness.LONG)
            before = sliders.get_configuration()
            after = sliders.update_configuration({"wind_y": -2.5})
            topic = "/world_wind" if arguments else "/wind"
            with Recording(topic, Vector3Stamped) as wind:
                step(1)
                value = wind.wait(lambda m: m[-1].header.stamp.to_nsec() == 1_000_000)[-1].vector
            harness.call("/gazebo/reset_world")  # the slider follows
            harness.wait_until(lambda: sliders.get_configuration()["wind_y"] == before["wind_y"])
            sliders.close()
            node.end()
        axes = [[values[f"wind_{axis}"] for axis in "xyz"] for values in (before, after)]
        return (*axes, [value.x, value.y, value.z])

    def test_sliders_set_the_mean_wind(self):
        plugin = (
            '<plugin name="wind" filename="libwind_plugin.so"><velocity>3 1 0</velocity></plugin>'
        )
        urdf = description(dragModel="chapter2")
        windy = urdf.replace("</robot>", f"<gazebo>{plugin}</gazebo></robot>")
        world = harness.folder_of(self) / "windy.world"
        wind = "<wind><linear_velocity>3 1 0</linear_velocity></wind>"
        world.write_text(f"<sdf version='1.6'><world name='windy'>{wind}</world></sdf>")
        for given, model in (((), windy), ((f"_world:={world}",), urdf)):
            before, after, air = self.set_wind(*given, urdf=model)
            self.assertEqual((before, after, air), ([3, 1, 0], [3, -2.5, 0], [3, -2.5, 0]))

    def test_a_flight_without_wind_refuses_one(self):
        with flight(PAUSED) as node:
            sliders = Client("/quadcore", timeout=harness.LONG)
            with self.assertRaises(DynamicReconfigureCallbackException):
                sliders.update_configuration({"wind_x": 1})
            self.assertEqual(sliders.update_configuration({"wind_x": 0})["wind_x"], 0)
            sliders.close()
            node.end()
        self.assertIn("this flight has no wind. Add libwind_plugin.so to the model", node.error)

    def test_sliders_change_the_gains_of_a_controller(self):
        hold = ("_law:=pd_compensated", "_reference:=hover")
        lockstep = ("_lockstep:=true", "_lockstep_timeout:=30", "_real_time_factor:=0")
        if rospy.has_param("/controller"):
            rospy.delete_param("/controller")
        with flight(PAUSED, *lockstep), Process("controller_node", *hold):
            sliders = Client("/controller", timeout=harness.LONG)
            gains = sliders.get_configuration()
            name = next(gain for gain in gains if gain.startswith("kp"))
            step(10)
            changed = sliders.update_configuration({name: 2 * gains[name]})
            self.assertEqual(changed[name], 2 * gains[name])
            with self.assertRaises(DynamicReconfigureCallbackException):
                sliders.update_configuration({name: float("nan")})
            self.assertEqual(sliders.get_configuration()[name], 2 * gains[name])
            step(10)
            sliders.close()

    def test_a_log_has_every_nth_state(self):
        log = harness.folder_of(self) / "flight.csv"
        with flight(PAUSED, f"_log:={log}", "_log_every:=10") as node:
            step(105)
            node.end()
        rows = [line.split(",") for line in log.read_text().splitlines() if line[0].isdigit()]
        self.assertEqual([float(row[0]) for row in rows], [i / 100 for i in range(11)])

    def test_the_page_of_a_flight_gets_its_rows(self):
        with flight(PAUSED), Process("view", "_browser:=false") as view:
            address = view.process.stdout.readline().split()[-1]
            page = urllib.request.urlopen(address, timeout=harness.LONG).read().decode()
            self.assertIn("quadrotor", page)
            step(100)
            with urllib.request.urlopen(address + "events", timeout=harness.LONG) as events:
                rows = []
                while len(rows) < 2:
                    line = events.readline().decode()
                    if line.startswith("data:"):
                        rows += json.loads(line[5:])["rows"]
        self.assertEqual(rows[0][:4], [0, 0, 0, 10])

    def test_layouts_show_what_exists(self):
        shown = [c.get("name") for c in ElementTree.parse(CONFIG / "plotjuggler.xml").iter("curve")]
        perspective = json.loads((CONFIG / "quadrotor.perspective").read_text())
        groups = perspective["groups"]["pluginmanager"]["groups"].values()
        for group in groups:
            topics = group["groups"].get("plugin", {"keys": {}})["keys"].get("topics")
            shown += ast.literal_eval(topics["repr"]) if topics else []
        with flight(PAUSED):
            with Recording("/joint_states", JointState) as joints:
                state = joints.wait_for_count(1)[0]
            with Recording("/odom", Odometry) as odometry:
                message = odometry.wait_for_count(1)[0]
        self.assertEqual(len(shown), 20)
        for name in shown:
            _, topic, *fields = name.split("/")
            if topic == "joint_states" and len(fields) == 2:
                self.assertIn(fields[0], state.name)
                continue
            value = {"odom": message, "joint_states": state}[topic]
            for field, index in (re.fullmatch(r"(\w+)(?:\[(\d)\])?", f).groups() for f in fields):
                value = (
                    getattr(value, field) if index is None else getattr(value, field)[int(index)]
                )
            self.assertIsInstance(value, float)


if __name__ == "__main__":
    harness.run("tools", TestTools)
