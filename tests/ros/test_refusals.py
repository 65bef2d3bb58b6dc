#!/usr/bin/env python3
"""What no flight can mean is refused with its reason, and the flight goes on."""

import unittest

import harness
import rospy
from gazebo_msgs import msg, srv
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from harness import description, flight, step
from quadcore.srv import ApplyWrench, SetState

NAN, INFINITE = float("nan"), float("inf")
FRAME = "quadrotor::frame"
PUSH = '<gazebo><plugin name="push" filename="libpush_plugin.so"/></gazebo>'
LEVEL = Pose(Point(0, 0, 10), Quaternion(w=1))


def apply_wrench(wrench, point=None):
    """Ask for a push of a second; return what is answered."""
    call = rospy.ServiceProxy("/gazebo/apply_body_wrench", srv.ApplyBodyWrench)
    return call(FRAME, "", point or Point(), wrench, rospy.Time(), rospy.Duration(1))


def set_state(pose=LEVEL, twist=None, rotors=()):
    return rospy.ServiceProxy("/quadcore/set_state", SetState)(pose, twist or Twist(), rotors)


class TestRefusals(unittest.TestCase):
    def assert_refused(self, response, why):
        self.assertFalse(response.success)
        said = response.status_message if hasattr(response, "status_message") else response.message
        self.assertIn(why, said)

    def test_a_wrench_that_is_not_physical_is_refused_and_the_flight_goes_on(self):
        urdf = description().replace("</robot>", PUSH + "</robot>")
        with flight("_paused:=true", urdf=urdf):
            push = rospy.ServiceProxy("/push", ApplyWrench)
            for wrench, why in (
                (Wrench(Vector3(NAN, 0, 0), Vector3()), "not a finite number"),
                (Wrench(Vector3(), Vector3(0, 0, INFINITE)), "not a finite number"),
                (Wrench(Vector3(0, -1e300, 0), Vector3()), "The force of "),
                (Wrench(Vector3(0, 1e9, 0), Vector3()), "The force of 1e+09 N is not physical"),
                (Wrench(Vector3(), Vector3(1e6, 0, 0)), "The torque of 1e+06 N m is not physical"),
            ):
                with self.subTest(wrench=wrench):
                    self.assert_refused(apply_wrench(wrench), why)
                    self.assert_refused(push(wrench), why)
                    step(5)
            far = Point(NAN, 0, 0)
            self.assert_refused(apply_wrench(Wrench(Vector3(0, 1, 0), Vector3()), far), "finite")
            step(5)
            self.assertTrue(apply_wrench(Wrench(Vector3(100, 0, 0), Vector3())).success)
            step(5)

    def test_a_state_that_has_diverged_is_refused_and_the_flight_goes_on(self):
        with flight("_paused:=true"):
            fast = Twist(Vector3(0, 0, 2e6), Vector3())
            for response, why in (
                (set_state(rotors=[1e7, 0, 0, 0]), "the velocity of a rotor is 1e+07 rad/s, but"),
                (set_state(twist=fast), "the velocity is 2e+06 m/s, but"),
                (set_state(twist=Twist(Vector3(), Vector3(3e6, 0, 0))), "the angular velocity is"),
                (set_state(Pose(Point(0, 0, 1e10), LEVEL.orientation)), "the distance from the"),
                (set_state(rotors=[NAN, 0, 0, 0]), "not a finite number"),
            ):
                self.assert_refused(response, why)
                step(5)

    def test_a_model_state_that_has_diverged_is_refused_and_the_flight_goes_on(self):
        with flight("_paused:=true"):
            change = rospy.ServiceProxy("/gazebo/set_model_state", srv.SetModelState)
            for pose, twist, why in (
                (Pose(Point(NAN, 0, 0), LEVEL.orientation), Twist(), "not a finite number"),
                (Pose(Point(1e12, 0, 0), LEVEL.orientation), Twist(), "the distance from the"),
                (Pose(Point(), Quaternion(w=NAN)), Twist(), "not a finite number"),
                (LEVEL, Twist(Vector3(1e9, 0, 0), Vector3()), "the velocity is 1e+09 m/s"),
            ):
                state = msg.ModelState("quadrotor", pose, twist, "")
                self.assert_refused(change(state), why)
                step(5)

    def test_physics_without_a_finite_rate_are_refused(self):
        with flight("_paused:=true"):
            now = rospy.ServiceProxy("/gazebo/get_physics_properties", srv.GetPhysicsProperties)()
            change = rospy.ServiceProxy("/gazebo/set_physics_properties", srv.SetPhysicsProperties)
            for rate in (NAN, INFINITE, -1):
                response = change(now.time_step, rate, now.gravity, now.ode_config)
                self.assert_refused(response, "max_update_rate is not valid. Give a number >= 0;")

    def test_parameters_out_of_range_are_errors_of_one_line(self):
        rospy.set_param("/robot_description", description())
        for argument, message in (
            ("_dt:=0.5", "parameter ~dt: give a step from 1e-9 to 0.1 s, or 0 for the step of"),
            ("_dt:=-0.001", "parameter ~dt: give a step from 1e-9 to 0.1 s"),
            ("_dt:=1e-12", "parameter ~dt: give a step from 1e-9 to 0.1 s"),
            ("_lockstep_timeout:=0", "parameter ~lockstep_timeout: give a number > 0"),
            ("_lockstep_timeout:=-1", "parameter ~lockstep_timeout: give a number > 0"),
            ("_real_time_factor:=-1", "parameter ~real_time_factor: give a number >= 0"),
            ("_log:=x.txt", "parameter ~log: give a file that ends in .csv, .mat or .bag, not x.t"),
            ("_log:=flight", "parameter ~log: give a file that ends in .csv, .mat or .bag"),
            ("_z:=1e12", "spawn: the distance from the origin is 1e+12 m, but a flight counts as"),
            ("_seed:=-1", "parameter ~seed: give a whole number from 0"),
        ):
            with self.subTest(argument=argument):
                if rospy.has_param("/quadcore"):
                    rospy.delete_param("/quadcore")
                status, error = harness.outcome(argument)
                self.assertEqual(status, 2)
                self.assertIn(f"error: {message}", error)
                self.assertEqual(len(error.splitlines()), 1, error)
        rospy.delete_param("/quadcore")


if __name__ == "__main__":
    harness.run("refusals", TestRefusals)
