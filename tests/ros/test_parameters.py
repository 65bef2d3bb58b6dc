#!/usr/bin/env python3
"""Parameters that change the model, and those that are changed during a flight."""

import unittest

import harness
import rospy
from harness import (
    Process,
    Recording,
    description,
    diagnostic,
    flight,
    step,
)
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock, Log

import quadcore as qc

EFFECTS = ("profile", "parasitic", "translational", "induced")


def final(*arguments, steps=300, **parameters):
    """Speed at the end of a short flight, from a start on its side."""
    start = ("_paused:=true", "_roll:=1", "_pitch:=0.5")
    topic = Recording("/odom", Odometry)
    with flight(*start, *arguments, parameters=parameters), topic as odometry:
        odometry.wait_for_publisher()
        step(steps)
        message = odometry.wait(lambda m: len(m) >= steps)[-1]
    v = message.twist.twist.linear
    return [v.x, v.y, v.z]


def fly_in_python(steps=300, **parameters):
    """The same in Python."""
    simulation = qc.Simulation(
        "quadrotor",
        world="default",
        xacro_args={"sim_slow": 1},
        spawn=(0, 0, 10, 1, 0.5, 0),
        parameters={f"drone_plugin.{tag}": value for tag, value in parameters.items()},
    )
    simulation.step(steps)
    return list(simulation.state.linear_velocity)


def refusal(*arguments, urdf=None):
    """The line of a node that refuses to start."""
    rospy.set_param("robot_description", urdf or description())
    if rospy.has_param("quadcore"):
        rospy.delete_param("quadcore")
    with Process("quadcore_node", *arguments) as node:
        status, error = node.result()
    if rospy.has_param("quadcore"):
        rospy.delete_param("quadcore")
    assert status == 2 and len(error.splitlines()) == 1, error
    return error


class TestParameters(unittest.TestCase):
    def test_set_gives_tags_other_values(self):
        given = "_set:=drone_plugin.parasiticDragCoeff=0.5 drone_plugin.profileDragCoeff=0.1"
        self.assertEqual(final(given), fly_in_python(parasiticDragCoeff=0.5, profileDragCoeff=0.1))
        listed = [
            "drone_plugin.parasiticDragCoeff=0.5",
            "motorpid_plugin.rotorJoints=rotor1 rotor2",
        ]
        self.assertEqual(final(set=listed), fly_in_python(parasiticDragCoeff=0.5))

    def test_wrong_settings_are_refused_as_on_the_command_line(self):
        for given, message in (
            ("kp", "parameter ~set: 'kp' is not valid. Write PLUGIN.TAG=VALUE."),
            ("motorpid_plugin.kp=", "is not valid. Write PLUGIN.TAG=VALUE."),
            ("a.b=1 a.b=2", "parameter ~set: a.b is given twice. Keep one."),
            (
                "motorpid.kp=1",
                "set motorpid.kp: the model has no plugin 'motorpid'. Did you mean 'motor",
            ),
            ("motorpid_plugin.kq=1", "kq"),
            ("motorpid_plugin.kp=-1", "kp"),
        ):
            self.assertIn(message, refusal(f"_set:={given}"))
        self.assertIn("give text, or a list of texts", refusal("_set:=3"))

    def test_drag_leaves_the_chosen_effect(self):
        for drag in ("none", *EFFECTS):
            off = {f"{effect}DragCoeff": 0 for effect in EFFECTS if effect != drag}
            self.assertEqual(final(f"_drag:={drag}"), fly_in_python(**off), drag)
        self.assertEqual(final("_drag:=all"), fly_in_python())

    def test_wrong_drags_are_refused(self):
        error = refusal("_drag:=profil")
        self.assertIn("parameter ~drag: 'profil' does not exist in this model. Did you mean", error)
        for effect in ("none", "all", *EFFECTS):
            self.assertIn(effect, error.split("Choose one of")[1])
        error = refusal("_drag:=none", "_set:=drone_plugin.profileDragCoeff=1")
        self.assertIn("sets drone_plugin.profileDragCoeff to 0, but ~set also sets it", error)

    def test_a_node_alone_has_a_ground(self):
        with flight("_z:=0.2", "_paused:=true"), Recording("/odom", Odometry) as odometry:
            odometry.wait_for_publisher()
            step(1000)
            height = odometry.wait(lambda m: len(m) >= 1000)[-1].pose.pose.position.z
        self.assertGreater(height, 0)

    def test_pause_and_pace_can_be_changed_while_it_flies(self):
        with flight("_real_time_factor:=0.5"), Recording("/clock", Clock) as clock:
            rospy.set_param("/quadcore/real_time_factor", 0.05)
            diagnostic("real-time factor", lambda factor: factor < 0.1)
            rospy.set_param("/quadcore/real_time_factor", 0)
            diagnostic("real-time factor", lambda factor: factor > 1)
            rospy.set_param("/quadcore/paused", True)
            diagnostic("real-time factor", lambda factor: factor == 0)
            paused_at = clock.messages[-1].clock
            rospy.set_param("/quadcore/paused", False)
            clock.wait(lambda m: m[-1].clock > paused_at)

    def test_parameters_that_are_fixed_in_flight_are_reported_once(self):
        messages = (
            "parameter ~engine: has no effect during a flight; only paused and real_time_",
            "parameter ~paused: give true or false",
            "parameter ~real_time_factor: give a number >= 0",
        )
        with flight("_engine:=ode") as node, Recording("/rosout", Log) as rosout:
            rosout.wait_for_connection(publishers=2)  # the node, and this test itself
            rospy.set_param("/quadcore/engine", "eigen")
            rospy.set_param("/quadcore/paused", "yes")
            rospy.set_param("/quadcore/real_time_factor", -1)
            for message in messages:
                rosout.wait(lambda logs, says=message: any(says in log.msg for log in logs))
            rospy.sleep(2.5)  # it looks once a second
            node.end()
        for message in messages:
            self.assertEqual(node.error.count(message), 1, node.error)

    def test_a_warning_is_logged_once_a_flight(self):
        with flight("_roll:=3", "_paused:=true") as node:
            for _ in "ab":
                step(100)
                step(100)
                harness.call("/gazebo/reset_simulation")
            node.end()
        self.assertEqual(node.error.count("a propeller tilts beyond 90 degrees"), 2)

    def test_what_is_foreign_can_be_ignored(self):
        foreign = '<plugin name="other" filename="libforeign_plugin.so"/>'
        urdf = description().replace("</robot>", f"<gazebo>{foreign}</gazebo></robot>")
        self.assertIn("libforeign_plugin.so", refusal(urdf=urdf))
        with flight("_ignore:=libforeign_plugin.so", "_paused:=true", urdf=urdf):
            step(1)
        self.assertIn(
            "ignore nothing: neither the model nor the world has anything of that name",
            refusal("_ignore:=nothing"),
        )

    def test_two_odometries_are_refused_by_name(self):
        second = '<plugin name="other" filename="libodometry_plugin.so"/>'
        urdf = description().replace("</robot>", f"<gazebo>{second}</gazebo></robot>")
        rospy.set_param("robot_description", urdf)
        with Process("quadcore_node") as node:
            status, error = node.result()
        self.assertEqual(status, 2)
        self.assertIn("plugin 'other' writes topic 'odom', which", error)
        self.assertIn("plugin 'odometry' already writes", error)


if __name__ == "__main__":
    harness.run("parameters", TestParameters)
