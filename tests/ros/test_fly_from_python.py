#!/usr/bin/env python3
"""The template for scripts speaks the topics of the node, and controller_node flies it."""

import os
import unittest
from pathlib import Path

import harness
import rosgraph
from harness import Recording
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from test_topics import PUBLISHED

import quadcore as qc


class TestFlyFromPython(unittest.TestCase):
    def test_it_hovers(self):
        with Recording("/odom", Odometry) as odometry:
            odometry.wait(lambda m: m and abs(m[-1].pose.pose.position.z - 1) < 0.02)
            message = odometry.messages[-1]
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("world", "drone"))
        self.assertEqual(message.pose.covariance[0], 1e-12)

    def test_topics_and_stamps(self):
        types = dict(rosgraph.Master("/test").getPublishedTopics(""))
        for topic in ("/odom", "/tf", "/clock", "/joint_states"):
            self.assertEqual(types[topic], PUBLISHED[topic][0])
        with Recording("/clock", Clock) as clock, Recording("/odom", Odometry) as odometry:
            begun = clock.wait_for_count(1)[0].clock

            def known(messages):
                return [m.header.stamp for m in messages if m.header.stamp >= begun]

            stamps = known(odometry.wait(lambda m: len(known(m)) >= 100))
            ticks = {m.clock for m in clock.wait(lambda m: m[-1].clock >= stamps[-1])}
        self.assertLessEqual(set(stamps), ticks)
        self.assertEqual({stamp.to_nsec() % 1000000 for stamp in stamps}, {0})

    def test_the_package_is_the_workspaces_and_flies_what_it_ships(self):
        space = os.environ["CMAKE_PREFIX_PATH"].split(":")[0]  # devel or install
        for file in (qc.__file__, qc._core.__file__, qc.plugin_folders()[-1]):
            self.assertIn(Path(space), Path(file).parents)
        self.assertEqual(qc.cmake_prefix(), space)
        sim = qc.Simulation("quadrotor", world="default")
        sim.step(10)
        self.assertEqual(sim.state.time, 0.01)


if __name__ == "__main__":
    harness.run("fly_from_python", TestFlyFromPython)
