#!/usr/bin/env python3
"""The commands of the pages are ones: those of this package start what they say."""

import os
import re
import shlex
import subprocess
import unittest
from pathlib import Path

import genpy
import harness
import rosgraph
import roslaunch
import roslib.message
import roslib.packages
import rospkg
import rospy
import scipy.io
import yaml
from harness import LONG, description, wait_until
from roslaunch.arg_dump import get_args

import quadcore as qc

FOLDER = Path(rospkg.RosPack().get_path("quadcore"))
PAGES = [FOLDER / "README.md", *sorted((FOLDER / "docs").glob("*.md"))]
NOT_EVERYWHERE = {"rviz", "joy", "teleop_twist_joy"}
SHELL = re.compile(r"^```sh\n(.*?)^```$", re.DOTALL | re.MULTILINE)
FILE = re.compile(r"^<!-- file: (\S+) -->\n+```\w*\n(.*?)^```$", re.DOTALL | re.MULTILINE)
COMMAND = re.compile(r"^(?:`|\s*)((?:roslaunch|rosrun) quadcore [^`#\n]*)")


def commands(program):
    """Give every command of a program for this package, in blocks and in the text, once."""
    found = {}
    for page in PAGES:
        text = page.read_text().replace("\\\n", " ")
        for line in [*text.splitlines(), *re.findall(r"`[^`\n]+`", text)]:
            match = COMMAND.match(line)
            if match and match.group(1).startswith(program):
                found.setdefault(tuple(shlex.split(match.group(1))[2:]), page.name)
    return found


class TestPages(unittest.TestCase):
    def test_what_the_pages_publish_are_messages(self):
        """Of types that there are, with fields that they have."""
        typed = "\n".join(text for page in PAGES for text in SHELL.findall(page.read_text()))
        found = re.findall(r"^rostopic pub [^']*'[^']*'", typed.replace("\\\n", " "), re.MULTILINE)
        self.assertGreater(len(found), 4)
        for command in found:
            with self.subTest(command=command):
                *_, kind, fields = shlex.split(command)
                message = roslib.message.get_message_class(kind)()
                genpy.message.fill_message_args(message, [yaml.safe_load(fields)])

    def test_what_the_pages_launch_are_nodes_that_there_are(self):
        """The arguments, too: roslaunch passes over those that a file does not declare."""
        found = commands("roslaunch")
        self.assertGreater(len(found), 8)
        folder = harness.folder_of(self)
        for name, text in (file for page in PAGES for file in FILE.findall(page.read_text())):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(str(folder))  # models are relative to it
        for (name, *arguments), page in found.items():
            with self.subTest(page=page, launch=name, arguments=arguments):
                [file] = roslib.packages.find_resource("quadcore", name)
                given = {argument.partition(":=")[0] for argument in arguments}
                self.assertLessEqual(given, set(get_args([file])))
                config = roslaunch.config.ROSLaunchConfig()
                roslaunch.xmlloader.XmlLoader().load(file, config, argv=arguments, verbose=False)
                config.assign_machines()
                self.assertEqual(config.config_errors, [])
                for node in config.nodes:
                    if node.package not in NOT_EVERYWHERE:
                        self.assertTrue(
                            roslib.packages.find_node(node.package, node.type), node.type
                        )

    def test_what_the_pages_run_starts(self):
        """Each in a folder with the files that it names, until the master knows its node."""
        folder = harness.folder_of(self)
        (folder / "my.urdf").write_text(description())
        log = qc.Simulation().run(0.01, [[0, 480, -480, 480, -480]], topics=["vel_cmd"])
        scipy.io.savemat(str(folder / "commands.mat"), {"commands": [[0.0, 480, -480, 480, -480]]})
        log.to_file(folder / "flight.csv")
        convert = [os.environ["QUADCORE_COMMAND"], "convert", "flight.csv", "flight.bag"]
        subprocess.run(convert, cwd=str(folder), env={"PATH": os.environ["PATH"]}, check=True)
        rospy.set_param("robot_description", description())
        found = commands("rosrun")
        self.assertGreater(len(found), 5)
        master = rosgraph.Master("/pages")

        def nodes():  # by their addresses: those that were killed keep their names
            known = {node for kind in master.getSystemState() for _, who in kind for node in who}
            return {master.lookupNode(node) for node in known}

        for arguments, page in found.items():
            with self.subTest(page=page, run=arguments):
                there = nodes()
                process = subprocess.Popen(
                    [harness.executable(arguments[0]), *arguments[1:]],
                    cwd=str(folder),
                    stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT,
                    text=True,
                )
                wait_until(lambda at=process, old=there: nodes() - old or at.poll() is not None)
                if process.poll() is None:
                    process.kill()
                said, _ = process.communicate(timeout=LONG)
                self.assertNotIn("Traceback", said)
                if arguments == ("spawn_model",):
                    self.assertIn("are required: -urdf, -model", said)
                else:
                    self.assertTrue(nodes() - there or process.returncode == 0, said)


if __name__ == "__main__":
    harness.run("pages", TestPages)
