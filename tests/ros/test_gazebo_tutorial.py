#!/usr/bin/env python3
"""The commands of gazebo_ros' tutorials "Using roslaunch" and "ROS communication", in their order.

Only what docs/migrating.md names differs: the package, and a world without gravity in the place of
a request that removes it.
"""

import subprocess
import unittest
from contextlib import contextmanager

import harness
import numpy as np
import yaml
from gazebo_msgs.msg import ModelStates
from harness import LONG, Process, Recording

import quadcore as qc

MODEL = "quad1"
LINK = f"{MODEL}::frame"
TILT = 2 * np.arctan2(0.491983115673, 0.870604813099)
ORIENTATION = "orientation: {x: 0, y: 0.491983115673, z: 0, w: 0.870604813099}"
REST = "twist: {linear: {x: 0, y: 0, z: 0}, angular: {x: 0, y: 0, z: 0}}"
SOLVER = """
time_step: 0.001
max_update_rate: 1000.0
gravity: {x: 0.0, y: 0.0, z: %g}
ode_config: {auto_disable_bodies: False, sor_pgs_precon_iters: 0, sor_pgs_iters: 50, sor_pgs_w: 1.3,
  sor_pgs_rms_error_tol: 0.0, contact_surface_layer: 0.001, contact_max_correcting_vel: 100.0,
  cfm: 0.0, erp: 0.2, max_contacts: 20}"""


def run(*words):
    """Documents that a command prints."""
    printed = subprocess.run(words, stdout=subprocess.PIPE, text=True, check=True, timeout=LONG)
    return list(yaml.safe_load_all(printed.stdout))


def call(service, request=""):
    """Response of `rosservice call`, or None if it is empty."""
    return next(iter(run("rosservice", "call", service, *([request] if request else []))), None)


def describe_state(x, y, z):
    place = f"pose: {{position: {{x: {x}, y: {y}, z: {z}}}, {ORIENTATION}}}"
    return f"{{model_name: {MODEL}, {place}, {REST}, reference_frame: world}}"


def push(torque):
    request = f"{{body_name: '{LINK}', wrench: {{torque: {{x: {torque}, y: 0, z: 0}}}}, "
    return call("/gazebo/apply_body_wrench", request + "start_time: 0, duration: 1000000000}")


@contextmanager
def publishing(topic, kind, message):
    """`rostopic pub -r 20`, for as long as the block."""
    words = ["rostopic", "pub", "-r", "20", topic, kind, message]
    publisher = subprocess.Popen(words, stdout=subprocess.PIPE)
    try:
        yield
    finally:
        publisher.terminate()
        publisher.communicate(timeout=LONG)


class TestGazeboTutorial(unittest.TestCase):
    def setUp(self):
        folder = harness.folder_of(self)
        (folder / "quad.urdf").write_text(harness.description(parasiticDragCoeff="0"))
        place = ("-file", str(folder / "quad.urdf"), "-urdf", "-y", "1", "-z", "5")
        name = ("-model", MODEL, "-robot_namespace", MODEL)
        spawned = Process("spawn_model", *place, *name)
        self.addCleanup(spawned.__exit__)
        self.states = Recording("/gazebo/model_states", ModelStates)
        self.states.wait(lambda m: MODEL in m[-1].name)

    def spin(self):
        """Angular velocity about x."""
        messages = self.states.messages
        return messages[-1].twist[messages[-1].name.index(MODEL)].angular.x

    def test_the_commands_of_the_tutorial(self):
        self.assertEqual(run("rosparam", "get", "/use_sim_time"), [True])

        state = ("/gazebo/set_model_state", "gazebo_msgs/ModelState", describe_state(1, 0, 2))
        with publishing(*state):
            self.states.wait(lambda m: m[-1].pose[-1].position.z == 2)
        [states] = run("rostopic", "echo", "-n", "1", "/gazebo/model_states")[:1]
        self.assertEqual(states["name"], ["ground_plane", MODEL][-len(states["name"]) :])
        links = run("rostopic", "echo", "-n", "1", "/gazebo/link_states")[0]
        self.assertIn(LINK, links["name"])

        moved = f"{{model_state: {describe_state(0.3, 0.2, 10)}}}"
        self.assertTrue(call("/gazebo/set_model_state", moved)["success"])
        pose = call("gazebo/get_model_state", f"{{model_name: {MODEL}}}")["pose"]
        at = [pose["position"][axis] for axis in "xyz"]
        np.testing.assert_allclose(at, [0.3, 0.2, 10], atol=1e-9)
        self.assertAlmostEqual(
            2 * np.arctan2(pose["orientation"]["y"], pose["orientation"]["w"]), TILT
        )
        self.assertIn(MODEL, call("gazebo/get_world_properties")["model_names"])
        properties = call("gazebo/get_model_properties", f"{{model_name: {MODEL}}}")
        self.assertEqual(len(properties["joint_names"]), 4)

        self.assertTrue(call("/gazebo/set_physics_properties", SOLVER % 0)["success"])
        refused = call("/gazebo/set_physics_properties", SOLVER % -9.8)
        self.assertFalse(refused["success"])
        self.assertIn("gravity cannot be changed", refused["status_message"])

        call("gazebo/reset_world")  # upright, so that x is a principal axis
        self.assertTrue(push(0.01)["success"])
        rate = 0.01 / qc.Simulation("quadrotor").inertia[0, 0]
        harness.wait_until(lambda: abs(self.spin() / rate - 1) < 0.05)
        self.assertTrue(push(-0.01)["success"])
        harness.wait_until(lambda: abs(self.spin()) < 0.05 * rate)
        call("/gazebo/clear_body_wrenches", f"{{body_name: '{LINK}'}}")

        call("gazebo/pause_physics")
        self.assertTrue(call("/gazebo/get_physics_properties")["pause"])
        call("gazebo/unpause_physics")
        call("gazebo/reset_world")
        pose = call("gazebo/get_model_state", f"{{model_name: {MODEL}}}")["pose"]
        np.testing.assert_allclose([pose["position"][axis] for axis in "xyz"], [0, 1, 5], atol=1e-9)


if __name__ == "__main__":
    harness.run("gazebo_tutorial", TestGazeboTutorial)
