#pragma once

#include <gazebo_msgs/GetPhysicsProperties.h>
#include <gazebo_msgs/SetPhysicsProperties.h>

#include "flight_thread.hpp"

/// \file
/// What gazebo_ros tells of the physics.

namespace quadcore::node {

void describe_physics(const Simulation& simulation, const FlightReport& report,
                      gazebo_msgs::GetPhysicsProperties::Response& response);
/// Throws InputError if anything but the rate is to change.
void check_physics(const Simulation& simulation,
                   const gazebo_msgs::SetPhysicsProperties::Request& request);
/// Simulated seconds per second that a rate of updates means.
double real_time_factor_of(const gazebo_msgs::SetPhysicsProperties::Request& request);

}  // namespace quadcore::node
