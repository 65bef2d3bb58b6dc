#!/usr/bin/env python3
"""A workspace that lacks a package of ROS says which, and one that lacks none has no warning."""

import subprocess
import unittest

import harness
import rospkg

PACKAGE = rospkg.RosPack().get_path("quadcore")
MISSING = "-DCMAKE_DISABLE_FIND_PACKAGE_nav_msgs=ON"  # as if it were not installed


class TestBuilding(unittest.TestCase):
    def configure(self, *arguments):
        """Exit status and everything printed of cmake in a folder of its own, in one line."""
        folder = harness.folder_of(self)
        prepared = ("-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DCMAKE_POLICY_VERSION_MINIMUM=3.5")
        run = subprocess.run(
            ["cmake", "-S", PACKAGE, "-B", str(folder), *prepared, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        return run.returncode, " ".join(run.stdout.split())

    def in_workspace(self, *arguments):
        """The same as catkin calls it, which says where the devel space is."""
        devel = harness.folder_of(self)
        return self.configure(f"-DCATKIN_DEVEL_PREFIX={devel}", *arguments)

    def test_a_workspace_is_configured_without_a_warning(self):
        status, printed = self.in_workspace()
        self.assertEqual(status, 0, printed)
        self.assertNotIn("CMake Warning at", printed)

    def test_a_workspace_without_a_message_package_is_an_error_that_names_it(self):
        status, printed = self.in_workspace(MISSING)
        self.assertNotEqual(status, 0)
        self.assertIn("quadcore's ROS node cannot be built; not found: nav_msgs.", printed)
        self.assertRegex(printed, "apt-get install (libnav-msgs-dev|ros-noetic-nav-msgs) ")
        self.assertIn("configure with -DQUADCORE_WITH_ROS=OFF.", printed)

    def test_a_workspace_may_leave_the_node_out(self):
        status, printed = self.in_workspace(MISSING, "-DQUADCORE_WITH_ROS=OFF")
        self.assertEqual(status, 0, printed)
        self.assertNotIn("nav_msgs.", printed)

    def test_plain_cmake_warns_that_it_builds_no_node(self):
        status, printed = self.configure(MISSING)
        self.assertEqual(status, 0, printed)
        self.assertIn("CMake Warning at", printed)
        self.assertIn("quadcore is built without its ROS node; not found: nav_msgs.", printed)
        self.assertRegex(printed, "apt-get install (libnav-msgs-dev|ros-noetic-nav-msgs)")


if __name__ == "__main__":
    harness.run("building", TestBuilding)
