#!/usr/bin/env python3
"""Offer hector_quadrotor's actions, its service and its stamped velocities.

``roslaunch quadcore quadrotor.launch hector:=true`` starts this node beside a controller. Actions
``action/pose``, ``action/takeoff`` and ``action/landing`` send set points on ``command/pose``, and
``command/twist`` becomes ``cmd_vel``. The messages are those of hector_uav_msgs, which
cpp/ros/packages contains.

Parameters as in hector_quadrotor_actions: ``dist_tolerance`` (0.05 m), ``yaw_tolerance``
(0.35 rad), ``time_in_tolerance`` (1 s), ``action_frequency`` (10 1/s), ``action_timeout`` (30 s),
``takeoff_height`` (0.3 m). In addition, ``landing_height`` (0 m) is that of the ground.
"""

import math

import actionlib
import rospy
from geometry_msgs.msg import Point, PoseStamped, Twist, TwistStamped
from hector_uav_msgs.msg import (
    LandingAction,
    LandingFeedback,
    PoseAction,
    PoseFeedback,
    TakeoffAction,
    TakeoffFeedback,
)
from hector_uav_msgs.srv import EnableMotors, EnableMotorsResponse
from nav_msgs.msg import Odometry


def yaw_of(turn):
    """Return the yaw of an orientation (rad)."""
    return math.atan2(
        2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y * turn.y + turn.z * turn.z)
    )


class HectorNames:
    """Actions of hector_quadrotor as set points of quadcore's controller."""

    def __init__(self):
        self._near = rospy.get_param("dist_tolerance", 0.05)
        self._aligned = rospy.get_param("yaw_tolerance", 0.35)
        self._stay = rospy.Duration(rospy.get_param("time_in_tolerance", 1.0))
        self._rate = rospy.get_param("action_frequency", 10.0)
        self._patience = rospy.Duration(rospy.get_param("action_timeout", 30.0))
        self._takeoff_height = rospy.get_param("takeoff_height", 0.3)
        self._landing_height = rospy.get_param("landing_height", 0.0)
        self._odometry = rospy.wait_for_message("ground_truth/state", Odometry)
        rospy.Subscriber("ground_truth/state", Odometry, self._take, queue_size=1)
        self._poses = rospy.Publisher("command/pose", PoseStamped, queue_size=1)
        self._velocities = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("command/twist", TwistStamped, self._forward, queue_size=1)
        rospy.Service("enable_motors", EnableMotors, self._enable)
        self._servers = [
            self._serve("action/pose", PoseAction, PoseFeedback, lambda goal: goal.target_pose),
            self._serve("action/takeoff", TakeoffAction, TakeoffFeedback, self._above),
            self._serve("action/landing", LandingAction, LandingFeedback, self._below),
        ]

    def _take(self, message):
        self._odometry = message

    def _forward(self, message):
        self._velocities.publish(message.twist)

    def _enable(self, request):
        if not request.enable:
            rospy.logwarn("enable_motors: the controller has no switch. Pause the flight instead.")
        return EnableMotorsResponse(success=request.enable)

    def _pose(self):
        """Return the present pose."""
        return PoseStamped(header=self._odometry.header, pose=self._odometry.pose.pose)

    def _above(self, _goal):
        target = self._level_pose()
        target.pose.position.z = self._takeoff_height
        return target

    def _below(self, goal):
        target = (
            self._level_pose() if goal.landing_zone.header.stamp.is_zero() else goal.landing_zone
        )
        target.pose.position.z = self._landing_height
        return target

    def _level_pose(self):
        """Return the present position and yaw."""
        here = self._odometry.pose.pose
        target = PoseStamped(header=self._odometry.header)
        target.pose.position = Point(here.position.x, here.position.y, here.position.z)
        yaw = yaw_of(here.orientation)
        target.pose.orientation.z, target.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        return target

    def _serve(self, name, action, feedback, find_target):
        def execute(goal):
            self._fly_to(server, find_target(goal), feedback)

        server = actionlib.SimpleActionServer(name, action, execute, auto_start=False)
        server.start()
        return server

    def _is_there(self, target):
        here = self._odometry.pose.pose
        away = math.dist(*([p.x, p.y, p.z] for p in (here.position, target.position)))
        turned = yaw_of(here.orientation) - yaw_of(target.orientation)
        return away <= self._near and abs(math.remainder(turned, math.tau)) <= self._aligned

    def _fly_to(self, server, target, feedback):
        """Hold the target until the vehicle stayed there, or the time is over."""
        started = outside = rospy.Time.now()
        rate = rospy.Rate(self._rate)
        while not rospy.is_shutdown():
            now = rospy.Time.now()
            if server.is_preempt_requested():
                if not server.is_new_goal_available():
                    self._poses.publish(self._level_pose())  # stay here
                return server.set_preempted()
            self._poses.publish(target)
            server.publish_feedback(feedback(current_pose=self._pose()))
            if not self._is_there(target.pose):
                outside = now
            elif now - outside > self._stay:
                return server.set_succeeded()
            if now - started > self._patience:
                return server.set_aborted()
            rate.sleep()
        return None


if __name__ == "__main__":
    rospy.init_node("hector_names")
    HectorNames()
    rospy.spin()
