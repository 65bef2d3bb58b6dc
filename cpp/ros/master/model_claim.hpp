#pragma once

#include <ros/ros.h>

#include <string>

namespace quadcore::node {

/// Claims the name of a model in the one world of /gazebo, where each name belongs to one model. If
/// several nodes start at once, the one that the master knew first gets it.
/// \return what holds the claim as long as it lives
/// Throws InputError if another node flies a model of that name.
ros::Publisher claim_model(ros::NodeHandle& nh, const std::string& model);

}  // namespace quadcore::node
