#!/usr/bin/env python3
"""The tutorial's package is built and flies as it stands in the text."""

import re
import signal
import subprocess
import unittest
from pathlib import Path

import harness
import numpy as np
import rospkg
from harness import LONG, Recording
from nav_msgs.msg import Odometry

FILE = re.compile(r"^<!-- file: (\S+) -->\n```\w+\n(.*?)^```$", re.DOTALL | re.MULTILINE)
GOAL = [1.0, -0.5, 2.0]


class TestTutorial(unittest.TestCase):
    def test_the_node_of_the_text_flies_to_its_goal(self):
        folder = harness.folder_of(self)
        page = Path(rospkg.RosPack().get_path("quadcore")) / "docs" / "tutorials" / "own_node.md"
        for name, content in FILE.findall(page.read_text()):
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(content)
        [typed] = re.findall(r"^```sh\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)
        typed = typed.replace(
            "roslaunch hold hold.launch", "exec roslaunch hold hold.launch gui:=false"
        )
        launched = subprocess.Popen(["bash", "-ec", typed], cwd=str(folder))
        try:
            with Recording("/odom", Odometry) as odometry:
                last = odometry.wait(lambda m: m and m[-1].header.stamp.to_sec() > 10)[-1]
        finally:
            launched.send_signal(signal.SIGINT)
            launched.wait(LONG)
        p, v = last.pose.pose.position, last.twist.twist.linear
        np.testing.assert_allclose([p.x, p.y, p.z], GOAL, atol=0.02)
        np.testing.assert_allclose([v.x, v.y, v.z], [0, 0, 0], atol=0.02)


if __name__ == "__main__":
    harness.run("tutorial", TestTutorial)
