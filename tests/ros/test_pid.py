#!/usr/bin/env python3
"""pid.launch flies the spiral of the thesis."""

import unittest

import harness
import numpy as np
import rospy
from geometry_msgs.msg import Vector3Stamped
from harness import Recording
from nav_msgs.msg import Odometry


class TestPid(unittest.TestCase):
    def test_it_flies_the_spiral(self):
        with Recording("/controller/error", Vector3Stamped) as error:
            errors = error.wait(lambda m: m and m[-1].header.stamp.to_sec() > 30)
            with Recording("/odom", Odometry) as odometry:
                message = odometry.wait(lambda m: m[-1].header.stamp.to_sec() > 30)[-1]
        late = [e.vector for e in errors if e.header.stamp.to_sec() > 25]
        # What the PID of section 6.2 reaches with a gain that flies is 28 mm, in the long run.
        self.assertLess(max(np.linalg.norm([e.x, e.y, e.z]) for e in late), 0.035)
        t, p = message.header.stamp.to_sec(), message.pose.pose.position
        spiral = [2 * np.cos(0.5 * t), 2 * np.sin(0.5 * t), 10 + t]
        np.testing.assert_allclose([p.x, p.y, p.z], spiral, atol=0.04)
        self.assertEqual(rospy.get_param("/controller/law"), "pid")


if __name__ == "__main__":
    harness.run("pid", TestPid)
