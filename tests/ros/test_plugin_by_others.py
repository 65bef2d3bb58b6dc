#!/usr/bin/env python3
"""The example plugin, built against the workspace by scripts/test_ros.sh, flies in the node."""

import unittest

import harness
from harness import Recording, description, flight, step
from nav_msgs.msg import Odometry

import quadcore as qc

FORCE = 0.5  # N
STEPS = 200
DRAGS = ("induced", "translational", "profile", "parasitic")
PUSH = f"""
<gazebo>
  <plugin name="push" filename="libside_force_plugin.so"><sideForce>{FORCE}</sideForce></plugin>
</gazebo>
</robot>"""


class TestPluginByOthers(unittest.TestCase):
    def test_it_pushes_the_vehicle(self):
        mass = qc.Simulation("quadrotor").mass
        without_drag = description(**{f"{drag}DragCoeff": "0" for drag in DRAGS})
        urdf = without_drag.replace("</robot>", PUSH)
        for engine in ("gazebo11", "ode", "eigen"):
            start = ("_paused:=true", f"_engine:={engine}")
            with flight(*start, urdf=urdf), Recording("/odom", Odometry) as odometry:
                odometry.wait_for_publisher()
                step(STEPS)
                message = odometry.wait_for_count(STEPS)[-1]
            pushed = FORCE / mass * STEPS * 0.001
            self.assertAlmostEqual(message.twist.twist.linear.y, pushed, delta=1e-9)


if __name__ == "__main__":
    harness.run("plugin_by_others", TestPluginByOthers)
