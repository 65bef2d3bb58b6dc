#!/usr/bin/env python3
"""Payloads, faults of rotors and pushes by topic and by service, turbulence and noise: in lockstep
the flight is that in process, byte for byte."""

import unittest

import harness
import numpy as np
import rospy
from geometry_msgs.msg import Vector3, Wrench, WrenchStamped
from harness import HOVER, Recording, commander, description, flight, step, wait_until
from nav_msgs.msg import Odometry
from quadcore.srv import ApplyWrench, Publish, Step
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool

import quadcore as qc

STEPS = 300
LOCKSTEP = ("_paused:=true", "_lockstep:=true", "_real_time_factor:=0", "_lockstep_timeout:=30")
TOPICS = ["odom", "payload", "push", "fault", "effectiveness", "power"]
TYPES = {"payload": Float64MultiArray, "push": WrenchStamped, "fault": Float64MultiArray}
PUSH = [1.5, -0.7, 0.2, 0.001, 0.002, -0.003]
EVENTS = {40: ("payload", [0]), 90: ("push", PUSH), 150: ("fault", [2, 0.4, 1]),
          200: ("payload", [1]), 240: ("push", [0.0] * 6), 270: ("fault", [3, 1, 0])}  # fmt: skip


def plugin(name, **tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return f'<plugin name="{name}" filename="lib{name}_plugin.so">{inner}</plugin>'


def describe_with(*plugins, **tags):
    inner = "".join(plugins)
    return description(**tags).replace("</robot>", f"<gazebo>{inner}</gazebo></robot>")


BEFALLEN = describe_with(
    plugin("payload", mass="0.13", xyz="0.02 -0.01 -0.07", inertia="2e-4 0 0 1e-4 0 3e-4"),
    plugin("push", xyz="0.01 0.02 0"),
    plugin("fault"),
)


def speeds(x, vz, turn):
    """Commands that depend on every digit of the odometry."""
    return [h * (1 - 0.02 * vz - 0.001 * x) + (-1) ** i * turn for i, h in enumerate(HOVER)]


def wrench(row):
    return Wrench(Vector3(*row[:3]), Vector3(*row[3:]))


class ByService:
    """Says to the plugins what happens, and returns once they know."""

    def __enter__(self):
        self.calls = {
            "payload": rospy.ServiceProxy("/payload", SetBool),
            "push": rospy.ServiceProxy("/push", ApplyWrench),
            "fault": rospy.ServiceProxy("/fault", Publish),
        }
        return self

    def __exit__(self, *_):
        pass

    def __call__(self, name, row):
        request = {"payload": lambda: bool(row[0]), "push": lambda: wrench(row)}
        response = self.calls[name](request.get(name, lambda: row)())
        assert response.success, response.message


class ByTopic:
    """The same by publishers. Without a queue rospy sends in the thread that publishes, and the
    answer to a second call of step tells that what was sent has been read."""

    def __enter__(self):
        self.publishers = {
            name: rospy.Publisher(f"/{name}", message_type, queue_size=None, tcp_nodelay=True)
            for name, message_type in TYPES.items()
        }
        for publisher in self.publishers.values():
            wait_until(lambda publisher=publisher: publisher.get_num_connections() > 0)
        self.answered = rospy.ServiceProxy("/quadcore/step", Step, persistent=True)
        return self

    def __exit__(self, *_):
        for publisher in self.publishers.values():
            publisher.unregister()

    def __call__(self, name, row):
        publisher = self.publishers[name]
        if name == "push":
            message = WrenchStamped()
            message.wrench = wrench(row)
            publisher.publish(message)
        else:
            publisher.publish(data=row)
        self.answered(0)


class TestDisturbances(unittest.TestCase):
    def setUp(self):
        self.folder = harness.folder_of(self)

    def assert_flown_as_in_process(self, urdf, topics, say=None, seed=0):
        ros_log, core_log = self.folder / "ros.csv", self.folder / "core.csv"
        arguments = (f"_log:={ros_log}", f"_log_topics:={' '.join(topics)}", f"_seed:={seed}")
        with flight(*LOCKSTEP, *arguments, urdf=urdf), commander() as send:

            def answer(message):
                tick = round(message.header.stamp.to_sec() * 1000)
                if say and tick in EVENTS:
                    say(*EVENTS[tick])
                p, v = message.pose.pose.position, message.twist.twist
                send(speeds(p.x, v.linear.z, v.angular.x))

            def fly():
                with Recording("/odom", Odometry, act=answer) as odometry:
                    odometry.wait_for_connection()
                    step(STEPS)
                    odometry.wait_for_count(STEPS + 1)

            if say is None:
                fly()
            else:
                with say:
                    fly()
        (self.folder / "model.urdf").write_text(urdf)
        self.in_process(topics, seed, events=say is not None).to_csv(core_log)
        self.assertEqual(len(ros_log.read_text().splitlines()), STEPS + 2)
        self.assertEqual(ros_log.read_bytes(), core_log.read_bytes())

    def in_process(self, topics, seed, events):
        simulation = qc.Simulation(self.folder / "model.urdf", seed=seed)
        pieces = [simulation.run(0, topics=topics)]
        for tick in range(STEPS):
            if events and tick in EVENTS:
                simulation.publish(*EVENTS[tick])
            said = simulation.topic("odom")
            simulation.command(speeds(said["x"], said["vz"], said["wx"]))
            pieces.append(simulation.run(simulation.dt, topics=topics))
        rows = [pieces[0].table, *(piece.table[1:] for piece in pieces[1:])]
        topics = {
            name: {
                field: np.concatenate(
                    [column, *(piece.topics[name][field][1:] for piece in pieces[1:])]
                )
                for field, column in pieces[0].topics[name].items()
            }
            for name in topics
        }
        return qc.Log(np.concatenate(rows), {}, topics=topics)

    def test_what_happens_by_service_is_flown_as_what_is_published_in_process(self):
        self.assert_flown_as_in_process(BEFALLEN, TOPICS, ByService())

    def test_what_happens_by_topic_is_flown_as_what_is_published_in_process(self):
        self.assert_flown_as_in_process(BEFALLEN, TOPICS, ByTopic())

    def test_turbulence_and_noise_are_the_same_bytes_through_ros(self):
        noise = {"positionNoise": "0.01", "linearVelocityNoise": "0.05", "orientationNoise": "0.02"}
        wind = plugin("wind", velocity="3 -2 0.5", turbulence="15", gusts="2 1 0 0.05 0.1")
        urdf = describe_with(wind, dragModel="chapter2", **noise)
        self.assert_flown_as_in_process(urdf, ["odom", "wind"], seed=23)

    def test_an_impossible_request_fails_and_changes_nothing(self):
        with flight("_paused:=true", urdf=BEFALLEN), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            step(5)
            publish = rospy.ServiceProxy("/fault", Publish)
            for values, why in (
                ([1, 1], "2 numbers are given. Give 3"),
                ([1, float("nan"), 1], "finite"),
            ):
                response = publish(values)
                self.assertFalse(response.success)
                self.assertIn(why, response.message)
            self.assertTrue(publish([1, 1, 1]).success)
            step(1)
            self.assertEqual(len(odometry.wait_for_count(6)), 6)  # and none between the steps


if __name__ == "__main__":
    harness.run("disturbances", TestDisturbances)
