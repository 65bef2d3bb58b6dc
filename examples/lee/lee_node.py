#!/usr/bin/env python3
"""Lee's controller as a ROS node, which answers each odometry message with rotor speeds."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import rospy
from lee import Lee
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64MultiArray

import quadcore as qc


def to_array(message):
    """Return the components of a vector or a quaternion."""
    return np.array([getattr(message, name) for name in "xyzw" if hasattr(message, name)])


def main():
    """Command the vehicle; the controller models quadcore's quadrotor."""
    rospy.init_node("lee")
    wanted = qc.references.parse(rospy.get_param("~reference", "circle:radius=1,rate=1"))
    lee = Lee()
    lee.reset(qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1}))
    commands = rospy.Publisher(
        "quadrotor/vel_cmd", Float64MultiArray, queue_size=1, tcp_nodelay=True
    )

    def answer(message):
        t = message.header.stamp.to_sec()
        state = SimpleNamespace(
            position=to_array(message.pose.pose.position),
            orientation=to_array(message.pose.pose.orientation),
            linear_velocity=to_array(message.twist.twist.linear),
            angular_velocity=to_array(message.twist.twist.angular),
        )
        commands.publish(data=lee(t, state, wanted(t)))

    rospy.Subscriber("odom", Odometry, answer, tcp_nodelay=True)
    rospy.spin()


if __name__ == "__main__":
    main()
