#pragma once

#include <gazebo_msgs/GetPhysicsProperties.h>
#include <gazebo_msgs/SetPhysicsProperties.h>

#include "flight_thread.hpp"

/// \file
/// Physics properties of gazebo_ros.

namespace quadcore::node {

void describe_physics(const Simulation& simulation, const FlightReport& report,
                      gazebo_msgs::GetPhysicsProperties::Response& response);
/// Throws InputError if the request changes anything except the rate.
void check_physics(const Simulation& simulation,
                   const gazebo_msgs::SetPhysicsProperties::Request& request);
/// Returns the simulated seconds per second for an update rate.
double compute_real_time_factor(const gazebo_msgs::SetPhysicsProperties::Request& request);

}  // namespace quadcore::node
