#!/usr/bin/env python3
"""Alarms of the node: a controller that stops, and a followed clock that jumps."""

import signal
import subprocess
import sys
import time
import unittest

import harness
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from harness import HOVER, Recording, commander, diagnostic, flight, step
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock, Log

# A controller in a process of its own, which commands hover at 100 Hz until it is killed.
CONTROLLER = f"""
import rospy
from std_msgs.msg import Float64MultiArray
rospy.init_node("victim", disable_rostime=True)
out = rospy.Publisher("/quadrotor/vel_cmd", Float64MultiArray, queue_size=1, tcp_nodelay=True)
rate = rospy.Rate(100)
while not rospy.is_shutdown():
    out.publish(data={HOVER})
    rate.sleep()
"""
STOPPED = "the controller has stopped sending commands on /quadrotor/vel_cmd"


def warnings_about(recording, text):
    """Messages of rosout at warning level or above that contain a text."""
    return [m for m in recording.messages if m.level >= Log.WARN and text in m.msg]


def send_clock(publisher, times):
    for t in times:
        publisher.publish(clock=rospy.Time(t))
        time.sleep(0.002)


class TestAlarms(unittest.TestCase):
    def test_a_controller_that_is_killed_raises_one_alarm_at_once(self):
        topics = Recording("/diagnostics", DiagnosticArray), Recording("/rosout", Log)
        # Slow motion, so that a busy machine delays no command of a healthy controller for long.
        slow = ("_real_time_factor:=0.1", "_command_timeout:=0.05")
        with flight(*slow), topics[0] as diagnostics, topics[1] as rosout:
            victim = subprocess.Popen([sys.executable, "-c", CONTROLLER])
            try:
                diagnostic("commands", lambda count: count >= 20)
                self.assertEqual(warnings_about(rosout, "the controller has stopped"), [])
                died = harness.time_of_flight().to_sec()
                victim.send_signal(signal.SIGKILL)
            finally:
                victim.kill()
                victim.wait()
            alarm = diagnostics.wait(lambda m: m[-1].status[0].message == STOPPED)[-1]
            self.assertGreaterEqual(alarm.status[0].level, 1)
            self.assertLess(alarm.header.stamp.to_sec() - died, 0.1)
            harness.wait_until(lambda: warnings_about(rosout, "the controller has stopped"))
            diagnostic("time (s)", lambda t: t > alarm.header.stamp.to_sec() + 0.1)
            self.assertEqual(len(warnings_about(rosout, "the controller has stopped")), 1)
            self.assertGreaterEqual(diagnostic("late commands"), 1)
            with commander() as send:  # another controller takes over
                for _ in range(3):
                    send(HOVER)
                harness.wait_for_status("running")

    def test_healthy_controllers_raise_no_alarm(self):
        for rate in (50, 500, 1000):
            slow = ("_real_time_factor:=0.1", f"_set:=odometry.rate={rate}")
            with flight(*slow), Recording("/rosout", Log) as rosout, commander() as send, Recording(
                "/odom", Odometry, act=lambda _, send=send: send(HOVER)
            ):
                diagnostic("commands", lambda count: count >= 15)
                begin = harness.time_of_flight().to_sec()
                diagnostic("time (s)", lambda t, end=begin + 0.3: t >= end)
            self.assertEqual(warnings_about(rosout, "the controller has stopped"), [], rate)

    def test_commands_sent_by_hand_raise_no_alarm(self):
        still = ("_paused:=true", "_real_time_factor:=0")
        with flight(*still), Recording("/rosout", Log) as rosout:
            with commander() as send:
                for count in (1, 2, 3):
                    send(HOVER)
                    diagnostic("commands", lambda now, count=count: now == count)
                    step(100)
            step(2000)
            self.assertEqual(diagnostic("late commands"), 0)
            self.assertEqual(warnings_about(rosout, "the controller has stopped"), [])

    def test_a_followed_clock_that_jumps_is_joined_with_one_warning_each_time(self):
        clock = rospy.Publisher("/clock", Clock, queue_size=1000, latch=True)
        topics = Recording("/odom", Odometry), Recording("/rosout", Log)
        node = flight("_clock:=follow", "_z:=1000")
        with node, topics[0] as odom, topics[1] as rosout:
            send_clock(clock, [0.001 * i for i in range(1, 101)])
            odom.wait(lambda m: m[-1].header.stamp.to_sec() == 0.1)
            for begin in (100.0, 0.01):
                send_clock(clock, [begin + 0.001 * i for i in range(101)])
                ahead = odom.wait(
                    lambda m, end=begin + 0.1: abs(m[-1].header.stamp.to_sec() - end) < 1e-6
                )
            harness.wait_until(lambda: len(warnings_about(rosout, "/clock jumped")) == 2)
            time.sleep(1.5)  # a clock that stops and goes on has not jumped
            send_clock(clock, [0.11 + 0.001 * i for i in range(1, 101)])
            resumed = odom.wait(lambda m: abs(m[-1].header.stamp.to_sec() - 0.21) < 1e-6)
            self.assertEqual(len(resumed), len(ahead) + 100)
            self.assertEqual(len(warnings_about(rosout, "/clock jumped")), 2)
        times = [message.header.stamp.to_sec() for message in ahead]
        self.assertLess(len(times), 400)  # nothing between was simulated
        fall = 1000 - ahead[-1].pose.pose.position.z
        self.assertAlmostEqual(fall, 9.8 / 2 * (0.001 * len(times)) ** 2, delta=0.03)
        clock.unregister()


if __name__ == "__main__":
    harness.run("alarms", TestAlarms)
