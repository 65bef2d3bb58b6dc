#!/usr/bin/env python3
"""Topics of plugins by others, carried both ways by their kind. The relay hands a topic on."""

import os
import tempfile
import unittest
from pathlib import Path

import harness
import numpy as np
import rospy
from geometry_msgs.msg import Vector3Stamped, WrenchStamped
from harness import Recording, commander, description, flight, step, wait_until
from nav_msgs.msg import Odometry
from quadcore.srv import Step
from sensor_msgs.msg import Imu
from std_msgs.msg import Float64MultiArray

import quadcore as qc

STEPS = 400


def relay(name, **tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return f'<plugin name="{name}" filename="librelay_plugin.so">{inner}</plugin>'


def with_plugins(*elements):
    inner = "".join(elements)
    return description().replace("</robot>", f"<gazebo>{inner}</gazebo></robot>")


ECHO = relay("hand", takes="push", publishes="echo", gain=2)


def publisher(topic, message_type, queue_size=1000):
    """A publisher that the node listens to."""
    made = rospy.Publisher(topic, message_type, queue_size=queue_size, tcp_nodelay=True)
    wait_until(lambda: made.get_num_connections() > 0)
    return made


class TestPluginTopics(unittest.TestCase):
    def test_a_topic_of_an_unknown_kind_is_an_array_both_ways(self):
        with flight(urdf=with_plugins(ECHO)), Recording("/echo", Float64MultiArray) as echo:
            first = echo.wait_for_count(1)[0]
            (fields,) = first.layout.dim
            self.assertEqual((fields.label, fields.size, fields.stride), ("a, b", 2, 2))
            push = publisher("/push", Float64MultiArray)
            push.publish(data=[1000, 3000])
            last = echo.wait(lambda m: m[-1].data[0] >= 2000)[-1]
            self.assertAlmostEqual(last.data[1] - last.data[0], 4000)

    def test_each_kind_travels_in_its_own_type(self):
        def vector(message):
            message.vector.x, message.vector.y, message.vector.z = 1000, 2000, 3000

        def wrench(message):
            message.wrench.force.x, message.wrench.torque.z = 1000, 6000

        def imu(message):
            message.angular_velocity.x, message.linear_acceleration.z = 1000, 6000

        def odometry(message):
            message.pose.pose.position.x, message.twist.twist.angular.z = 1000, 6000

        for kind, message_type, fill, ends, frame in (
            ("vector", Vector3Stamped, vector, lambda m: (m.vector.x, m.vector.z), ""),
            (
                "wrench",
                WrenchStamped,
                wrench,
                lambda m: (m.wrench.force.x, m.wrench.torque.z),
                "drone",
            ),
            ("imu", Imu, imu, lambda m: (m.angular_velocity.x, m.linear_acceleration.z), "drone"),
            (
                "odometry",
                Odometry,
                odometry,
                lambda m: (m.pose.pose.position.x, m.twist.twist.angular.z),
                "world",
            ),
        ):
            # Names of their own: this process keeps a topic's first type.
            urdf = with_plugins(relay("hand", takes=f"in_{kind}", publishes=kind, kind=kind))
            with self.subTest(kind), flight(urdf=urdf), Recording(f"/{kind}", message_type) as echo:
                echo.wait_for_count(1)
                message = message_type()
                fill(message)
                publisher(f"/in_{kind}", message_type).publish(message)
                last = echo.wait(lambda m, ends=ends: ends(m[-1])[0] >= 1000)[-1]
                # What is measured has the time of the measurement, here when the step began.
                measured = kind not in ("vector", "wrench")
                time = last.header.stamp.to_sec() - (0 if measured else 0.001)
                first_field, last_field = ends(last)
                self.assertAlmostEqual(first_field - 1000, time, delta=1e-6)
                self.assertGreater(last_field, 2999)
                self.assertEqual(last.header.frame_id, frame)

    def test_a_second_odometry_is_sent_on_its_own_topic(self):
        second = '<plugin name="second" filename="libodometry_plugin.so">{}</plugin>'.format(
            "<topic>slow</topic><rate>100</rate><positionNoise>0.1</positionNoise>"
        )
        topics = Recording("/odom", Odometry), Recording("/slow", Odometry)
        node = flight("_paused:=true", urdf=with_plugins(second))
        with node, topics[0] as odom, topics[1] as slow:
            odom.wait_for_publisher()
            slow.wait_for_publisher()
            step(100)
            truth, noisy = odom.wait_for_count(100), slow.wait_for_count(10)
        self.assertEqual([m.header.stamp for m in noisy], [m.header.stamp for m in truth[9::10]])
        self.assertNotEqual(noisy[-1].pose.pose.position.x, truth[-1].pose.pose.position.x)
        self.assertEqual(noisy[-1].pose.covariance[0], 0.1**2)
        self.assertEqual(noisy[-1].child_frame_id, "drone")

    def test_a_message_of_the_wrong_length_is_reported_and_changes_nothing(self):
        with flight(urdf=with_plugins(ECHO)) as node:
            with Recording("/echo", Float64MultiArray) as echo:
                echo.wait_for_count(1)
                push = publisher("/push", Float64MultiArray)
                push.publish(data=[1])
                push.publish(data=[1000, 0])
                echo.wait(lambda m: m[-1].data[0] >= 2000)
            node.end()
        self.assertIn("topic 'push': 1 numbers are given. Give 2: a, b", node.error)

    def test_topics_lie_in_the_vehicles_namespace(self):
        urdf = with_plugins(ECHO)
        received = Recording("/uav7/echo", Float64MultiArray)
        with flight(urdf=urdf, namespace="/uav7"), received as echo:
            echo.wait_for_count(1)
            publisher("/uav7/push", Float64MultiArray).publish(data=[1000, 0])
            echo.wait(lambda m: m[-1].data[0] >= 2000)

    def test_a_plugin_that_takes_the_name_of_one_of_the_nodes_topics_is_refused(self):
        for tags in ({"publishes": "path"}, {"takes": "joint_states"}):
            rospy.set_param("/robot_description", with_plugins(relay("hand", **tags)))
            status, error = harness.Process("quadcore_node", "_z:=10").result()
            self.assertEqual(status, 2)
            (name,) = tags.values()
            self.assertIn(f"error: topic '{name}' of a plugin has the name of a topic", error)

    def test_in_lockstep_what_is_sent_before_a_command_is_flown_as_in_process(self):
        offsets = np.random.default_rng(5).uniform(-20, 20, (STEPS + 1, 6))
        table = np.array([*harness.HOVER, 0, 0]) + offsets
        # A topic of its own: this process keeps the queue that a topic once had.
        urdf = with_plugins(relay("hand", takes="shove", publishes="echo", gain=2))
        with tempfile.TemporaryDirectory() as folder:
            ros_log, core_log = Path(folder, "ros.csv"), Path(folder, "core.csv")
            lockstep = ("_paused:=true", "_lockstep:=true", "_real_time_factor:=0")
            log = (f"_log:={ros_log}", "_log_topics:=echo shove vel_cmd odom")
            with flight(*lockstep, "_lockstep_timeout:=30", *log, urdf=urdf):
                # Without a queue rospy sends in the thread that publishes. Between two connections
                # only an answer tells that the one was read before the other is written to: a
                # second call of step gets one at once.
                shove = publisher("/shove", Float64MultiArray, queue_size=None)
                answered = rospy.ServiceProxy("/quadcore/step", Step, persistent=True)
                with commander() as send:

                    def answer(message):
                        row = table[round(message.header.stamp.to_sec() * 1000)]
                        if row[4] > 0:  # now and then
                            shove.publish(data=row[4:])
                            answered(0)
                        send(row[:4])

                    with Recording("/odom", Odometry, act=answer) as odometry:
                        odometry.wait_for_connection()
                        step(STEPS)
                        odometry.wait_for_count(STEPS + 1)
            Path(folder, "model.urdf").write_text(urdf)
            simulation = qc.Simulation(Path(folder, "model.urdf"))
            self.fly(simulation, table).to_csv(core_log)
            self.assertEqual(ros_log.read_bytes(), core_log.read_bytes())

    def fly(self, simulation, table):
        """The same flight in this process."""
        topics = ["echo", "shove", "vel_cmd", "odom"]
        flown = [simulation.run(0, topics=topics)]
        for row in table[:STEPS]:
            if row[4] > 0:
                simulation.publish("shove", row[4:])
            simulation.command(row[:4])
            log = simulation.run(simulation.dt, topics=topics)
            flown.append(log)
        join = np.concatenate
        return qc.Log(
            join([flown[0].table, *(log.table[1:] for log in flown[1:])]),
            {},
            topics={
                name: {
                    field: join([first, *(log.topics[name][field][1:] for log in flown[1:])])
                    for field, first in flown[0].topics[name].items()
                }
                for name in topics
            },
        )


if __name__ == "__main__":
    assert os.environ["QUADCORE_PLUGIN_PATH"], "the relay is built by scripts/test_ros.sh"
    harness.run("plugin_topics", TestPluginTopics)
