#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/JointState.h>

#include <string>

#include "messages.hpp"
#include "quadcore/state.hpp"

/// \file
/// Messages of tf and joint_states for a vehicle.

namespace quadcore::node {

constexpr const char* truth_topic = "ground_truth/odometry";
constexpr const char* joint_states_topic = "joint_states";
constexpr double joint_states_rate = 50;  ///< messages per simulated second

/// Returns the transform of a frame that coincides with its parent.
inline geometry_msgs::TransformStamped make_identity_transform(const std::string& parent,
                                                               const std::string& child) {
  geometry_msgs::TransformStamped same;
  same.header.frame_id = parent;
  same.child_frame_id = child;
  same.transform.rotation.w = 1;
  return same;
}

/// Returns the transform of a frame at a pose in its parent.
inline geometry_msgs::TransformStamped make_transform(const std::string& parent,
                                                      const std::string& child, const Pose& pose) {
  geometry_msgs::TransformStamped placed = make_identity_transform(parent, child);
  set_vector(placed.transform.translation, pose.xyz.data());
  const Quaterniond rotation = pose.rotation();
  set_quaternion(placed.transform.rotation, rotation.coeffs().data());
  return placed;
}

inline void to_ros(const VehicleState& state, geometry_msgs::Transform& vehicle) {
  set_vector(vehicle.translation, state.position.data());
  set_quaternion(vehicle.rotation, state.orientation.coeffs().data());
}

inline void to_ros(const VehicleState& state, sensor_msgs::JointState& joints) {
  const auto assign = [](std::vector<double>& to, const VectorXd& from) {
    to.assign(from.data(), from.data() + from.size());
  };
  assign(joints.position, state.rotor_angle);
  assign(joints.velocity, state.rotor_velocity);
}

}  // namespace quadcore::node
