#pragma once

#include "quadcore/plugin/spatial.hpp"

/// \file
/// Rounding of numbers from a URDF to a simulation in Gazebo 11: sdformat 9 prints them with 16
/// digits, reads them, and prints them again for the simulation.

namespace quadcore {

/// A pose with its rotation as a unit quaternion, as in urdfdom and sdformat.
struct SdfPose {
  Vector3d xyz = Vector3d::Zero();
  Quaterniond q = Quaterniond::Identity();

  SdfPose() = default;
  explicit SdfPose(const Pose& pose) : xyz(pose.xyz), q(pose.rotation()) {}
  SdfPose(const Vector3d& p, const Quaterniond& rotation) : xyz(p), q(rotation) {}
  /// Return the composition X_AC = X_AB * X_BC in sdformat's order of operations.
  SdfPose operator*(const SdfPose& other) const;
};

/// Return urdfdom's roll, pitch, yaw of a unit quaternion: for |sin pitch| >= 0.99999, roll is 0,
/// with an error of up to 0.0045 rad in pitch.
Vector3d urdf_rpy(const Quaterniond& q);

/// Round a mass, moment, length or coefficient to 6 significant digits.
double sdf_scalar(double value);
/// Round a vector: each component to 6 decimals, half away from zero, then to 6 significant digits.
Vector3d sdf_vector(const Vector3d& v);
/// Round a pose: its rotation is converted through a quaternion to roll, pitch, yaw (pitch within
/// +-90 degrees; at 90 degrees yaw is 0), and all six numbers are rounded like vectors.
Pose sdf_pose(const SdfPose& pose);
/// Round the pose of a shape; its rotation passes through urdf_rpy() first.
Pose sdf_shape_pose(const SdfPose& pose);

}  // namespace quadcore
