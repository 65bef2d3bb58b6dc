#!/usr/bin/env python3
"""The example of a controller as a node, in lockstep: the flight of the controller in Python."""

import signal
import subprocess
import sys
import unittest
from pathlib import Path

import harness
import rospkg
from harness import LONG, Recording, flight, step
from nav_msgs.msg import Odometry

import quadcore as qc

REFERENCE = "circle:radius=1,rate=1"
STEPS = 500
LOCKSTEP = ("_paused:=true", "_lockstep:=true", "_lockstep_timeout:=30", "_real_time_factor:=0")


class TestLee(unittest.TestCase):
    def test_the_node_is_a_row_equal_to_that_of_python(self):
        example = Path(rospkg.RosPack().get_path("quadcore")) / "examples" / "lee"
        log = harness.folder_of(self) / "ros.csv"
        command = [
            sys.executable,
            str(example / "lee_node.py"),
            f"_reference:={REFERENCE}",
            "__name:=controller",
        ]
        with flight(*LOCKSTEP, "_engine:=eigen", "_x:=1", f"_log:={log}"):
            node = subprocess.Popen(command)
            try:
                with Recording("/odom", Odometry) as odometry:
                    odometry.wait_for_connection()
                    step(STEPS)
                    odometry.wait_for_count(STEPS + 1)
            finally:
                node.send_signal(signal.SIGINT)
                node.wait(LONG)
        found = qc.measure(
            {"ros": log},
            REFERENCE,
            f"{example / 'lee.py'}:Lee",
            xacro_args={"sim_slow": 1},
            spawn=(1, 0, 10),
            log_every=1,
        )
        simulated, recorded = found.table
        self.assertEqual((simulated["failure"], recorded["failure"]), ("", ""))
        for name in ("rms_position", "max_position", "iae_position", "max_yaw"):
            self.assertAlmostEqual(simulated[name], recorded[name], delta=1e-9)


if __name__ == "__main__":
    harness.run("lee", TestLee)
