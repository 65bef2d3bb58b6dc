#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Twist.h>

#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

/// \file
/// Positions and velocities in the terms of gazebo_ros.

namespace quadcore::node {

/// Pose of a body and velocity of its origin, in the world.
struct BodyMotion {
  Vector3d position = Vector3d::Zero();               ///< m
  Quaterniond orientation = Quaterniond::Identity();  ///< unit
  Vector3d linear_velocity = Vector3d::Zero();        ///< m/s
  Vector3d angular_velocity = Vector3d::Zero();       ///< world axes [rad/s]
};

/// Computes the motion of each link of the model.
std::vector<BodyMotion> compute_body_motions(const Simulation& simulation);

/// Returns the motion of an entity of gazebo_ros: "", "world", "map", "ground_plane", MODEL,
/// MODEL::LINK or LINK, where MODEL is `model`. Throws InputError if it does not exist.
BodyMotion find_motion(const Simulation& simulation, const std::string& model,
                       const std::string& entity);

/// Expresses a motion relative to another body, in its axes.
BodyMotion express_in(const BodyMotion& other, const BodyMotion& body);

void to_ros(const BodyMotion& motion, geometry_msgs::Pose& pose, geometry_msgs::Twist& twist);

/// Converts a pose and a twist in the axes of another body to the world. As in Gazebo, the other
/// body's motion is not added, and a quaternion may have any length; 0 0 0 0 is the identity.
BodyMotion from_ros(const BodyMotion& other, const geometry_msgs::Pose& pose,
                    const geometry_msgs::Twist& twist);

}  // namespace quadcore::node
