#!/usr/bin/env python3
"""A node that was written for gazebo_ros finds here what it needs of it."""

import unittest

import harness
import numpy as np
import rospy
from gazebo_msgs import msg, srv
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from harness import LONG, Recording, description, flight, step

import quadcore as qc

# Those of the original package.
CHECKSUMS = {
    srv.ApplyBodyWrench: "585b9f9618aa0581b207e2f2d90866bc",
    srv.BodyRequest: "5eade9afe7f232d78005bd0cafeab755",
    srv.GetLinkState: "09d6c98cce97b35f7ab9bd70300657ab",
    srv.GetModelProperties: "5717f7bd34ed990fa80e28b3015027a3",
    srv.GetModelState: "4c515e936d3319c9610c559c60bfc3d4",
    srv.GetPhysicsProperties: "575a5e74786981b7df2e3afc567693a6",
    srv.GetWorldProperties: "36bb0f2eccf4d8be971410c22818ba3f",
    srv.SetModelState: "5b3ab0281d4f5445def017e3a2e4a07b",
    srv.SetPhysicsProperties: "97e2057080558ce4730434b5fae75c91",
    msg.LinkStates: "48c080191eb15c41858319b4d8a609c2",
    msg.ModelState: "9330fd35f2fcd82d457e54bd54e10593",
    msg.ModelStates: "48c080191eb15c41858319b4d8a609c2",
}
FRAME = "quadrotor::frame"
TILTED = Quaternion(0, 0.6, 0, 0.8)


def service(name, kind):
    """A service of gazebo_ros, ready."""
    rospy.wait_for_service(f"/gazebo/{name}", LONG)
    return rospy.ServiceProxy(f"/gazebo/{name}", kind)


def numbers(thing):
    """Numbers of a point, a vector or a quaternion."""
    return [getattr(thing, name) for name in thing.__slots__]


class TestGazebo(unittest.TestCase):
    def test_messages_are_those_of_the_original_package(self):
        for kind, checksum in CHECKSUMS.items():
            self.assertEqual(kind._md5sum, checksum, kind)

    def test_a_state_that_is_set_is_the_state_that_is_returned(self):
        with flight("_paused:=true"):
            models = Recording("/gazebo/model_states", msg.ModelStates).wait_for_connection()
            links = Recording("/gazebo/link_states", msg.LinkStates).wait_for_connection()
            get = service("get_model_state", srv.GetModelState)
            state = msg.ModelState(
                model_name="quadrotor",
                pose=Pose(Point(1, 2, 30), TILTED),
                twist=Twist(Vector3(0.5, 0, 0), Vector3(0, 0, 2)),
            )
            self.assertTrue(service("set_model_state", srv.SetModelState)(state).success)
            response = get("quadrotor", "")
            self.assertTrue(response.success)
            np.testing.assert_allclose(numbers(response.pose.position), [1, 2, 30])
            np.testing.assert_allclose(numbers(response.pose.orientation), [0, 0.6, 0, 0.8])
            np.testing.assert_allclose(numbers(response.twist.angular), [0, 0, 2], atol=1e-15)

            # Seen from itself it is at rest, and a rotor's arm is 0.2 m away and turns along.
            itself = get("quadrotor", FRAME)
            np.testing.assert_allclose(numbers(itself.pose.position), 0, atol=1e-14)
            np.testing.assert_allclose(numbers(itself.pose.orientation), [0, 0, 0, 1], atol=1e-14)
            np.testing.assert_allclose(numbers(itself.twist.linear), 0, atol=1e-14)
            message = models.wait(lambda m: m and m[-1].pose[-1].position.z == 30)[-1]
            self.assertEqual(message.name, ["ground_plane", "quadrotor"])
            np.testing.assert_allclose(numbers(message.twist[1].angular), [0, 0, 2], atol=1e-15)
            message = links.wait(lambda m: m and m[-1].pose[1].position.z == 30)[-1]
            self.assertEqual(message.name[:2], ["ground_plane::link", FRAME])
            self.assertEqual(len(message.name), 6)
            arm = np.array(numbers(message.pose[2].position)) - [1, 2, 30]
            speed = np.array(numbers(message.twist[2].linear)) - [0.5, 0, 0]
            np.testing.assert_allclose(speed, np.cross([0, 0, 2], arm), atol=1e-14)
            link = service("get_link_state", srv.GetLinkState)(message.name[2], FRAME)
            turned = np.array(
                [arm[0] * 0.28 - arm[2] * 0.96, arm[1], arm[0] * 0.96 + arm[2] * 0.28]
            )
            np.testing.assert_allclose(numbers(link.link_state.pose.position), turned, atol=1e-14)

    def test_a_state_by_topic_and_one_relative_to_the_vehicle(self):
        with flight("_paused:=true"):
            get = service("get_model_state", srv.GetModelState)
            topic = rospy.Publisher("/gazebo/set_model_state", msg.ModelState, queue_size=1)
            harness.wait_until(lambda: topic.get_num_connections() > 0)
            topic.publish(msg.ModelState(model_name="quadrotor", pose=Pose(Point(0, 0, 7), TILTED)))
            harness.wait_until(lambda: get("quadrotor", "").pose.position.z == 7)
            ahead = msg.ModelState(model_name="quadrotor", reference_frame="quadrotor")
            ahead.pose.position.x = 1  # and no orientation at all: none but the frame's
            self.assertTrue(service("set_model_state", srv.SetModelState)(ahead).success)
            pose = get("quadrotor", "world").pose
            np.testing.assert_allclose(numbers(pose.position), [0.28, 0, 7 - 0.96], atol=1e-14)
            np.testing.assert_allclose(numbers(pose.orientation), numbers(TILTED), atol=1e-14)

    def test_what_does_not_exist_is_said(self):
        with flight("_paused:=true"):
            response = service("get_model_state", srv.GetModelState)("quadrotr", "")
            self.assertFalse(response.success)
            self.assertEqual(
                response.status_message,
                "model 'quadrotr' does not exist. The model here is quadrotor.",
            )
            response = service("get_link_state", srv.GetLinkState)("quadrotor::fram", "")
            self.assertIn(
                "'quadrotor::fram' does not exist. Choose one of world", response.status_message
            )
            push = service("apply_body_wrench", srv.ApplyBodyWrench)
            response = push(body_name="quadrotor::rotor_1", duration=rospy.Duration(1))
            self.assertFalse(response.success)

    def test_a_wrench_acts_for_its_time(self):
        with flight("_paused:=true", urdf=description()):
            state = service("get_model_state", srv.GetModelState)
            push = service("apply_body_wrench", srv.ApplyBodyWrench)
            step(1)
            force = Wrench(force=Vector3(2, 0, 0))
            response = push(FRAME, "", Point(), force, rospy.Time(0.005), rospy.Duration(0.01))
            self.assertTrue(response.success)
            step(4)
            self.assertLess(abs(state("quadrotor", "").twist.linear.x), 1e-20)
            step(10)
            pushed = state("quadrotor", "").twist.linear.x
            weighs = qc.Simulation("quadrotor").mass
            self.assertAlmostEqual(pushed, 2 * 0.01 / weighs, delta=0.01 * pushed)
            step(10)
            self.assertAlmostEqual(
                state("quadrotor", "").twist.linear.x, pushed, delta=1e-3 * pushed
            )
            push(FRAME, "", Point(), force, rospy.Time(), rospy.Duration(-1))
            step(10)
            twice = state("quadrotor", "").twist.linear.x
            self.assertAlmostEqual(twice, 2 * pushed, delta=2e-3 * pushed)
            service("clear_body_wrenches", srv.BodyRequest)(FRAME)
            step(10)
            self.assertAlmostEqual(
                state("quadrotor", "").twist.linear.x, twice, delta=2e-3 * pushed
            )

    def test_physics_properties_are_returned_and_their_pace_set(self):
        with flight("_paused:=true", "_real_time_factor:=0.5"):
            get = service("get_physics_properties", srv.GetPhysicsProperties)
            change = service("set_physics_properties", srv.SetPhysicsProperties)
            now = get()
            self.assertEqual((now.time_step, now.pause, now.max_update_rate), (0.001, True, 500))
            self.assertEqual((now.gravity.z, now.ode_config.sor_pgs_iters), (-9.8, 50))
            response = change(now.time_step, 2000, now.gravity, now.ode_config)
            self.assertTrue(response.success, response.status_message)
            self.assertEqual(get().max_update_rate, 2000)
            response = change(0.002, 2000, now.gravity, now.ode_config)
            self.assertFalse(response.success)
            self.assertEqual(
                response.status_message,
                "time_step cannot be changed during a flight. Start with dt:=.",
            )
            world = service("get_world_properties", srv.GetWorldProperties)()
            self.assertEqual(world.model_names, ["ground_plane", "quadrotor"])
            model = service("get_model_properties", srv.GetModelProperties)("quadrotor")
            self.assertEqual(model.canonical_body_name, "frame")
            self.assertEqual(len(model.joint_names), 4)


if __name__ == "__main__":
    harness.run("gazebo", TestGazebo)
