#pragma once

#include "quadcore/plugin/spatial.hpp"

/// \file
/// Numbers on their way from a URDF to a flight in Gazebo 11: sdformat 9 prints them with 16
/// digits, reads them, and prints them again for the simulation.

namespace quadcore {

/// A pose whose rotation is a unit quaternion, as urdfdom and sdformat keep it.
struct SdfPose {
  Vector3d xyz = Vector3d::Zero();
  Quaterniond q = Quaterniond::Identity();

  SdfPose() = default;
  explicit SdfPose(const Pose& pose) : xyz(pose.xyz), q(pose.rotation()) {}
  SdfPose(const Vector3d& p, const Quaterniond& rotation) : xyz(p), q(rotation) {}
  /// Composition X_AC = X_AB * X_BC, in sdformat's order of operations.
  SdfPose operator*(const SdfPose& other) const;
};

/// urdfdom's roll, pitch, yaw of a unit quaternion: where |sin pitch| >= 0.99999 roll is 0, and up
/// to 0.0045 rad of pitch are lost.
Vector3d urdf_rpy(const Quaterniond& q);

/// A mass, moment, length, coefficient: 6 significant digits.
double sdf_scalar(double value);
/// A vector: each component rounded to 6 decimals, half away from zero, then 6 significant digits.
Vector3d sdf_vector(const Vector3d& v);
/// A pose: its rotation becomes roll, pitch, yaw by way of a quaternion (pitch within +-90 degrees;
/// at 90 degrees yaw is 0), all six rounded as a vector is.
Pose sdf_pose(const SdfPose& pose);
/// The pose of a shape, whose rotation passes through urdf_rpy() first.
Pose sdf_shape_pose(const SdfPose& pose);

}  // namespace quadcore
