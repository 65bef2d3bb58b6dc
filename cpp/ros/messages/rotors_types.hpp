#pragma once

#include <mav_msgs/Actuators.h>
#include <ros/ros.h>

#include <memory>
#include <string>

#include "quadcore/simulation.hpp"
#include "ros_types.hpp"

/// \file
/// What RotorS' modules say, in the types that they say it in.

namespace quadcore::node {

/// Advertises a topic of one of RotorS' modules under its own name; null if it is none that goes in
/// a type of its own.
/// \param frame  tf's name of what its numbers are in, or of what an odometry is of
/// \param root_frame  a frame that tf has anyway
std::unique_ptr<Outlet> make_rotors_outlet(ros::NodeHandle& nh, const Topic& topic,
                                           const LoadedPlugin& writer, const std::string& frame,
                                           const std::string& root_frame);

/// Where RotorS' motors take speeds directly; "" if the model has none.
std::string direct_motor_topic(const Simulation& simulation);

}  // namespace quadcore::node
