#!/usr/bin/env python3
"""What RotorS' modules take and tell in types of RotorS' own."""

import unittest

import harness
import numpy as np
import rospy
from geometry_msgs.msg import TwistStamped, WrenchStamped
from harness import Recording, flight, step
from mav_msgs.msg import Actuators
from rotors_comm.msg import WindSpeed
from sensor_msgs.msg import NavSatFix

from quadcore.model.description import load_description

# Those of the original packages.
CHECKSUMS = {
    Actuators: "25741daf38ed25442e3a66a855ee8d9c",
    WindSpeed: "ae00d2a331b8545eaf96c531128ff0ef",
}
WIND = (
    '<gazebo><plugin name="wind" filename="librotors_gazebo_wind_plugin.so">'
    "<linkName>windy/base_link</linkName><windForceMean>0.5</windForceMean>"
    "<windSpeedMean>3</windSpeedMean><windDirection>0 2 0</windDirection></plugin></gazebo>"
)
RECEIVER = (
    '<gazebo reference="windy/base_link"><sensor type="gps" name="gps">'
    '<plugin name="gps" filename="librotors_gazebo_gps_plugin.so">'
    "<linkName>windy/base_link</linkName></plugin></sensor></gazebo>"
)


def turning(speeds):
    """Whether the last message tells of rotors that turn as fast as they will."""
    return speeds.messages and abs(speeds.messages[-1].angular_velocities[0]) > 490


class TestRotorsTopics(unittest.TestCase):
    def test_messages_are_those_of_the_original_packages(self):
        for message, checksum in CHECKSUMS.items():
            self.assertEqual(message._md5sum, checksum)

    def test_motors_take_speeds_directly_and_the_wind_is_published(self):
        urdf = load_description("firefly", {"namespace": "windy"}).text
        urdf = urdf.replace("</robot>", WIND + RECEIVER + "</robot>")
        with flight("_paused:=true", urdf=urdf, namespace="/windy"):
            direct = rospy.Publisher("/windy/gazebo/command/motor_speed", Actuators, queue_size=1)
            speeds = Recording("/windy/motor_speed", Actuators)
            wind = Recording("/windy/wind_speed", WindSpeed)
            force = Recording("/windy/external_force", WrenchStamped)
            fix = Recording("/windy/gps", NavSatFix)
            ground_speed = Recording("/windy/ground_speed", TwistStamped)
            for topic in (speeds, wind, force, fix, ground_speed):
                topic.wait_for_connection()
            harness.wait_until(lambda: direct.get_num_connections() > 0)
            direct.publish(angular_velocities=[500] * 5)  # too few: refused
            direct.publish(angular_velocities=[500, 510, 520, 530, 540, 550])
            harness.wait_until(lambda: step(20, "/windy") and turning(speeds), harness.LONG)
            for topic in (wind, force, fix):
                topic.wait_for_count(1)
            ground_speed.wait(lambda m: m and m[-1].twist.linear.z != 0)
            velocities = speeds.messages[-1].angular_velocities
            self.assertTrue(
                np.allclose(velocities, [500, -510, 520, -530, 540, -550], rtol=0.05), velocities
            )
            self.assertEqual(wind.messages[-1].header.frame_id, "world")
            self.assertEqual(wind.messages[-1].velocity.y, 3)
            self.assertEqual(force.messages[-1].wrench.force.y, 0.5)
            self.assertEqual(fix.messages[-1].position_covariance[8], 36)  # RotorS' default
            self.assertLess(abs(fix.messages[-1].longitude), 1e-3)
            self.assertEqual(ground_speed.messages[-1].header.frame_id, "world")


if __name__ == "__main__":
    harness.run("rotors_topics", TestRotorsTopics)
