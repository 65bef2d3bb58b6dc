#!/usr/bin/env python3
"""joystick.launch flies by hand, with stand-ins for joy and teleop_twist_joy."""

import os
import signal
import subprocess
import unittest

import harness
import rospy
from harness import Process, Recording, flight, wait_for_status, wait_until
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Joy

IDLE = """#!/usr/bin/env python3
import rospy
rospy.init_node("joy")
rospy.spin()
"""
# What teleop_twist_joy sends with both sticks ahead.
PUSHED = """#!/usr/bin/env python3
import rospy
from geometry_msgs.msg import Twist, Vector3
rospy.init_node("teleop", disable_rostime=True)
scale = rospy.get_param("~scale_linear")
publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
rate = rospy.Rate(20)
while not rospy.is_shutdown():
    publisher.publish(linear=Vector3(scale["x"], 0, scale["z"]))
    rate.sleep()
"""
PACKAGE = """<package><name>{}</name><version>0.0.0</version><description/>
<maintainer email="nobody@example.org">nobody</maintainer><license>none</license></package>"""


def stand_in(folder, package, node, text):
    """A package of one node."""
    place = folder / package
    place.mkdir()
    (place / "package.xml").write_text(PACKAGE.format(package))
    (place / node).write_text(text)
    (place / node).chmod(0o755)


class TestJoystick(unittest.TestCase):
    def test_buttons_pause_step_and_reset(self):
        buttons = rospy.Publisher("joy", Joy, queue_size=10)
        with flight("_paused:=true"), Process("flight_buttons.py", "_paused:=true", "_steps:=50"):
            wait_until(lambda: buttons.get_num_connections() > 0)

            def press(button):
                for down in (1, 0):
                    state = [0] * 8
                    state[button] = down
                    buttons.publish(Joy(buttons=state))

            with Recording("/clock", Clock) as clock:
                clock.wait_for_connection()
                for total in (50, 100):
                    press(0)
                    clock.wait(lambda m, ns=total * 1_000_000: m and m[-1].clock.to_nsec() == ns)
                press(7)  # goes on
                clock.wait(lambda m: m[-1].clock.to_nsec() > 150_000_000)
                press(7)
                wait_for_status("paused")
                press(6)
                clock.wait(lambda m: m[-1].clock.to_nsec() == 0)

    def test_sticks_are_velocities_along_the_heading(self):
        folder = harness.folder_of(self)
        stand_in(folder, "joy", "joy_node", IDLE)
        stand_in(folder, "teleop_twist_joy", "teleop_node", PUSHED)
        path = f"{folder}:{os.environ['ROS_PACKAGE_PATH']}"
        options = ("gui:=false", "speed:=1.5", "climb:=0.8", "lockstep:=true")
        launch = subprocess.Popen(
            ["roslaunch", "quadcore", "joystick.launch", *options],
            env={**os.environ, "ROS_PACKAGE_PATH": path},
            stdout=subprocess.DEVNULL,
        )
        try:
            with Recording("/odom", Odometry) as odometry:
                odometry.wait(
                    lambda m: (
                        m
                        and abs(m[-1].twist.twist.linear.x - 1.5) < 0.02
                        and abs(m[-1].twist.twist.linear.z - 0.8) < 0.02
                    )
                )
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(harness.LONG)


if __name__ == "__main__":
    harness.run("joystick", TestJoystick)
