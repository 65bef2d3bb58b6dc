#pragma once

#include <mav_msgs/Actuators.h>
#include <ros/ros.h>

#include <memory>
#include <string>

#include "quadcore/simulation.hpp"
#include "ros_types.hpp"

/// \file
/// Topics of RotorS' modules in their ROS types.

namespace quadcore::node {

/// Advertises a topic of a RotorS module under its own name; null if the topic has no RotorS type.
/// \param root_frame  a frame that is already in tf
std::unique_ptr<Outlet> make_rotors_outlet(ros::NodeHandle& nh, const Topic& topic,
                                           const LoadedPlugin& writer, const MessageFrames& frames,
                                           const std::string& root_frame);

/// Returns the topic on which RotorS' motors receive speeds directly; "" if the model has no such
/// motors.
std::string direct_motor_topic(const Simulation& simulation);

}  // namespace quadcore::node
