#!/usr/bin/env python3
"""tf holds each link that does not move, also without a window and without joint states."""

import unittest
import xml.etree.ElementTree as ElementTree

import harness
import numpy as np
import rospy
from harness import Recording, description, flight, step
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage

LAMP = (
    '<link name="lamp"/><joint name="hook" type="fixed"><parent link="frame"/><child link="lamp"/>'
    '<origin xyz="0.1 0 -0.2" rpy="0 0 1.5707963267948966"/></joint>'
)


def static_frames(count):
    """Transforms on /tf_static by child frame, once there are so many."""

    def found(messages):
        return {t.child_frame_id: t for message in messages for t in message.transforms}

    with Recording("/tf_static", TFMessage) as recording:
        return found(recording.wait(lambda messages: len(found(messages)) >= count))


def numbers(thing):
    return [getattr(thing, name) for name in thing.__slots__]


class TestLinks(unittest.TestCase):
    def test_the_locked_links_of_a_rotors_vehicle_are_on_tf_static(self):
        urdf = ElementTree.fromstring(rospy.get_param("/firefly/robot_description"))
        joints = [j for j in urdf.iter("joint") if j.get("type") in ("fixed", "revolute")]
        frames = static_frames(len(joints) + 1)
        for joint in joints:
            transform = frames[joint.find("child").get("link")]
            self.assertEqual(transform.header.frame_id, joint.find("parent").get("link"))
            origin = joint.find("origin")  # without one it is where its parent is
            place = "0 0 0" if origin is None else origin.get("xyz")
            np.testing.assert_allclose(
                numbers(transform.transform.translation), np.array(place.split(), dtype=float)
            )
        for link in ("imu_link", "imugt_link", "odometry_sensorgt_link"):
            self.assertIn(f"firefly/{link}", frames)

    def test_the_frame_of_a_rotors_imu_exists(self):
        with Recording("/firefly/imu", Imu) as imu:
            step(20, "/firefly")
            frame = imu.wait_for_count(1)[0].header.frame_id
        self.assertIn(frame, static_frames(2))

    def test_a_link_on_a_fixed_joint_is_where_the_urdf_says(self):
        urdf = description().replace("</robot>", LAMP + "</robot>")
        lit = flight("_paused:=true", "_name:=lit", urdf=urdf, namespace="/lit")
        with lit, Recording("/tf_static", TFMessage) as recording:
            recording.wait(lambda ms: any("lit/lamp" in str(message) for message in ms))
            transforms = [t for message in recording.messages for t in message.transforms]
        (lamp,) = (t for t in transforms if t.child_frame_id == "lit/lamp")
        self.assertEqual(lamp.header.frame_id, "lit/frame")
        np.testing.assert_allclose(numbers(lamp.transform.translation), [0.1, 0, -0.2])
        np.testing.assert_allclose(numbers(lamp.transform.rotation), [0, 0, 0.5**0.5, 0.5**0.5])


if __name__ == "__main__":
    harness.run("links", TestLinks)
