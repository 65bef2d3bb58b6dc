#!/usr/bin/env python3
"""joystick.launch flies by hand, with stand-ins for joy and teleop_twist_joy."""

import os
import signal
import subprocess
import unittest

import harness
from harness import Recording
from nav_msgs.msg import Odometry

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
