#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Twist.h>

#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

/// \file
/// Where things are, in the terms of gazebo_ros.

namespace quadcore::node {

/// Where a body is and how its origin moves, all in the world.
struct BodyMotion {
  Vector3d position = Vector3d::Zero();               ///< m
  Quaterniond orientation = Quaterniond::Identity();  ///< unit
  Vector3d linear_velocity = Vector3d::Zero();        ///< m/s
  Vector3d angular_velocity = Vector3d::Zero();       ///< world axes [rad/s]
};

/// Of each of the model's links.
std::vector<BodyMotion> body_motions(const Simulation& simulation);

/// The thing that gazebo_ros calls so: "", "world", "map", "ground_plane", MODEL, MODEL::LINK or
/// LINK, where MODEL is `model`. Throws InputError if there is none.
BodyMotion motion_of(const Simulation& simulation, const std::string& model,
                     const std::string& entity);

/// As seen from another body, whose axes are used and whose own motion is taken off.
BodyMotion seen_from(const BodyMotion& other, const BodyMotion& body);

void to_ros(const BodyMotion& motion, geometry_msgs::Pose& pose, geometry_msgs::Twist& twist);

/// What a pose and a twist in the axes of another body mean in the world; as Gazebo has it, the
/// other's own motion is not added, and a quaternion of any length will do, 0 0 0 0 for no turn.
BodyMotion from_ros(const BodyMotion& other, const geometry_msgs::Pose& pose,
                    const geometry_msgs::Twist& twist);

}  // namespace quadcore::node
