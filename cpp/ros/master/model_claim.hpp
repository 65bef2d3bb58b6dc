#pragma once

#include <ros/ros.h>

#include <string>

namespace quadcore::node {

/// Claims the name of a model in the world of /gazebo, where names are unique. If several nodes
/// start at once, the first registered one gets the name.
/// \return object that holds the claim during its lifetime
/// Throws InputError if another node simulates a model of that name.
ros::Publisher claim_model(ros::NodeHandle& nh, const std::string& model);

}  // namespace quadcore::node
