#!/usr/bin/env python3
"""Step the simulation inside a rospy node.

This is a template for scripts. It has the topics of quadcore_node, in one process with the code
that you add between two steps. Run ``rosrun quadcore fly_from_python.py``, and in another terminal
``roslaunch quadcore controller.launch reference:=hover reference_parameters:='{height: 1}'``.
"""

import time

import numpy as np
import rospy
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage

import quadcore as qc
from quadcore.model.description import load_description

rospy.init_node("quadcore", disable_rostime=True)  # this node publishes the clock
# Read by controllers and rviz.
rospy.set_param("robot_description", load_description("quadrotor", {}).text)
sim = qc.Simulation("quadrotor", world="default", spawn=(0, 0, rospy.get_param("~z", 0.1)))

clock = rospy.Publisher("/clock", Clock, queue_size=1000, tcp_nodelay=True)
odom = rospy.Publisher("odom", Odometry, queue_size=1000, tcp_nodelay=True)
tf = rospy.Publisher("/tf", TFMessage, queue_size=100, tcp_nodelay=True)
joints = rospy.Publisher("joint_states", JointState, queue_size=100, tcp_nodelay=True)
commands = []  # received since the last step, in rospy's thread
rospy.Subscriber(
    f"{sim.model.name}/vel_cmd",
    Float64MultiArray,
    lambda message: commands.append(message.data),
    tcp_nodelay=True,
)


def covariance(translation, rotation):
    """Return the 36 numbers of a diagonal covariance that is never singular."""
    return np.diag(np.maximum([translation] * 3 + [rotation] * 3, 1e-12)).ravel()


def publish(sim):
    """Publish the topics that quadcore_node publishes after each step."""
    now = rospy.Time(nsecs=round(sim.time * 1e9))  # from_sec would truncate
    clock.publish(now)
    m = sim.topic("odom")
    message = Odometry(child_frame_id="drone")
    message.header.stamp, message.header.frame_id = now, "world"
    pose, twist = message.pose.pose, message.twist.twist
    pose.position = Point(m["x"], m["y"], m["z"])
    pose.orientation = Quaternion(m["qx"], m["qy"], m["qz"], m["qw"])
    twist.linear = Vector3(m["vx"], m["vy"], m["vz"])
    twist.angular = Vector3(m["wx"], m["wy"], m["wz"])
    message.pose.covariance = covariance(m["position_variance"], m["orientation_variance"])
    message.twist.covariance = covariance(
        m["linear_velocity_variance"], m["angular_velocity_variance"]
    )
    odom.publish(message)
    transform = TransformStamped(header=message.header, child_frame_id="drone")
    transform.transform.translation = Vector3(m["x"], m["y"], m["z"])
    transform.transform.rotation = pose.orientation
    tf.publish([transform])
    state = sim.state
    if round(sim.time / sim.dt) % 20 == 0:
        joints.publish(message.header, sim.rotor_names, state.rotor_angle, state.rotor_velocity, [])


start = time.monotonic()
while not rospy.is_shutdown():
    publish(sim)
    try:
        while commands:
            sim.command(commands.pop(0))
    except qc.InputError as error:
        rospy.logwarn(error)
    # Add your own controller, sensor or fault here.
    sim.step()
    time.sleep(max(0, start + sim.time - time.monotonic()))
