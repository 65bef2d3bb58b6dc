#!/usr/bin/env python3
"""To who asks in /gazebo, several vehicles are models of one world, each with a name of its own."""

import contextlib
import re
import signal
import subprocess
import unittest
from pathlib import Path

import harness
import rospkg
import rospy
from gazebo_msgs import msg, srv
from harness import LONG, Process, Recording, call, flight, outcome, wait_until

PAGE = Path(rospkg.RosPack().get_path("quadcore")) / "docs" / "ros.md"
EXAMPLE = re.compile(r"^## Several vehicles$.*?^```xml\n(.*?)^```$", re.DOTALL | re.MULTILINE)
MODELS = ["ground_plane", "first", "second", "third"]
TOPICS = {
    "/gazebo/model_states": (msg.ModelStates, len(MODELS)),
    "/gazebo/link_states": (msg.LinkStates, 1 + 5 * 3),
}


@contextlib.contextmanager
def three_vehicles(*arguments):
    """A leader and two followers that the leader knows."""
    with contextlib.ExitStack() as stack:
        for name in MODELS[1:]:
            stack.enter_context(flight(f"_name:={name}", *arguments, namespace=f"/{name}"))
        wait_until(lambda: sorted(model_names()) == sorted(MODELS))
        yield


def model_names():
    """Names of the models of the world, as gazebo_ros tells them."""
    return rospy.ServiceProxy("/gazebo/get_world_properties", srv.GetWorldProperties)().model_names


def first_message(topic, kind):
    """What somebody who comes now gets first."""
    with Recording(topic, kind) as recording:
        return recording.wait_for_count(1)[0]


class TestOneWorld(unittest.TestCase):
    def assert_first_messages_are_complete(self):
        for _ in range(5):  # each of which comes anew
            for topic, (kind, count) in TOPICS.items():
                message = first_message(topic, kind)
                self.assertEqual(len(message.name), count, message.name)
                self.assertEqual({name.split("::")[0] for name in message.name}, set(MODELS))
                self.assertEqual(len(message.pose), count)

    def test_the_first_states_that_a_newcomer_gets_are_those_of_all_vehicles(self):
        with three_vehicles():
            self.assert_first_messages_are_complete()

    def test_the_states_of_all_vehicles_are_seen_while_they_are_paused(self):
        with three_vehicles("_paused:=true"):
            self.assert_first_messages_are_complete()

    def test_who_waits_while_paused_sees_a_neighbour_that_moves(self):
        topic = Recording("/gazebo/model_states", msg.ModelStates)
        with three_vehicles("_paused:=true"), topic as states:
            states.wait(lambda m: len(m[-1].name) == len(MODELS))
            change = rospy.ServiceProxy("/gazebo/set_model_state", srv.SetModelState)
            state = msg.ModelState(model_name="third")
            state.pose.position.z = 25
            self.assertTrue(change(state).success)
            states.wait(lambda m: m[-1].pose[m[-1].name.index("third")].position.z == 25)

    def test_a_second_model_of_the_same_name_is_refused(self):
        with flight("_paused:=true", namespace="/a"):
            rospy.set_param("/b/robot_description", harness.description())
            status, error = outcome("__ns:=/b")
            self.assertEqual(status, 2)
            self.assertEqual(len(error.splitlines()), 1, error)
            self.assertIn(
                "error: parameter ~name: /a/quadcore already simulates a model 'quadrotor'.",
                error,
            )
            with flight("_name:=other", namespace="/b"):
                wait_until(lambda: sorted(model_names()) == ["ground_plane", "other", "quadrotor"])

    def test_of_two_models_of_one_name_that_start_at_once_one_flies(self):
        for space in "ab":
            if rospy.has_param(f"/{space}/quadcore"):
                rospy.delete_param(f"/{space}/quadcore")
            rospy.set_param(f"/{space}/robot_description", harness.description())
        start = ("quadcore_node", "_paused:=true")
        with Process(*start, "__ns:=/a") as a, Process(*start, "__ns:=/b") as b:
            wait_until(lambda: self.ended(a, b))
            (loser,) = self.ended(a, b)
            status, error = loser.result()
            self.assertEqual(status, 2)
            self.assertIn("already simulates a model 'quadrotor'", error)
            winner = "/b" if loser is a else "/a"
            rospy.wait_for_service(f"{winner}/quadcore/set_state", LONG)
            self.assertEqual(model_names(), ["ground_plane", "quadrotor"])

    @staticmethod
    def ended(*nodes):
        return [node for node in nodes if node.process.poll() is not None]

    def test_the_name_of_a_model_whose_node_was_killed_is_free(self):
        with flight("_paused:=true", namespace="/a") as node:
            node.process.kill()
            node.process.wait()
            with flight("_paused:=true", namespace="/b"):
                self.assertEqual(model_names(), ["ground_plane", "quadrotor"])

    def test_the_example_of_the_page_is_two_models_in_gazebo(self):
        example = harness.folder_of(self) / "two.launch"
        example.write_text(EXAMPLE.search(PAGE.read_text()).group(1))
        launch = subprocess.Popen(["roslaunch", str(example)], stdout=subprocess.DEVNULL)
        try:
            rospy.wait_for_service("/gazebo/get_world_properties", LONG)
            wait_until(lambda: sorted(model_names()) == ["first", "ground_plane", "second"])
            places = rospy.ServiceProxy("/gazebo/get_model_state", srv.GetModelState)
            self.assertEqual(round(places("first", "").pose.position.y), 0)
            self.assertEqual(round(places("second", "").pose.position.y), 2)
            call("/gazebo/pause_physics")
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(LONG)


if __name__ == "__main__":
    harness.run("one_world", TestOneWorld)
