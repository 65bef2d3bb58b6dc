#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "quadcore/plugin/export.hpp"

/// \file
/// Frames and monogram notation (after Drake's), used for every vector in quadcore:
///   W    world, z up, inertial
///   F    the frame link of the vehicle, at its origin
///   R    a rotor's link, at its origin, spinning with it
///   Bcm  centre of mass of body B; Ccm that of the whole vehicle
///   p_WF     position of F's origin from W's, expressed in W (the first letter names the axes
///            unless a suffix does)
///   v_WF_F   velocity of F's origin relative to W, expressed in F's axes
///   w_WF_F   angular velocity of F relative to W, expressed in F's axes
///   R_WF     rotation that takes components in F to components in W
///   f_F      force expressed in F's axes [N];  tau_F  torque expressed in F's axes [N m]

/// Simulation of multirotors: an Engine and plugins advance a Simulation of a Model in a World.
namespace quadcore QUADCORE_EXPORT {

static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && (EIGEN_MALLOC_ALREADY_ALIGNED || sizeof(void*) < 8),
              "Eigen's memory layout would differ from that of quadcore's libraries. Link the "
              "CMake target quadcore::quadcore, which carries the required definitions.");

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Return the rotation by fixed-axis roll, pitch, yaw [rad]: Rz(yaw) Ry(pitch) Rx(roll), the
/// convention of URDF and SDF (thesis eq. (2.8), corrected).
Quaterniond quaternion_from_rpy(const Vector3d& rpy);

/// Return the inverse of quaternion_from_rpy(), with the pitch in [-pi/2, pi/2].
Vector3d rpy_from_quaternion(const Quaterniond& q);

/// Return the rotation by an angle [rad] about a unit axis.
Quaterniond quaternion_about(const Vector3d& axis, double angle);

/// A pose as in a URDF: translation [m] and fixed-axis roll, pitch, yaw [rad].
struct Pose {
  Vector3d xyz = Vector3d::Zero();  ///< m
  Vector3d rpy = Vector3d::Zero();  ///< rad

  /// Return the orientation as a quaternion.
  Quaterniond rotation() const { return quaternion_from_rpy(rpy); }
  /// Return the composition X_AC = X_AB * X_BC.
  Pose operator*(const Pose& other) const;
};

/// Return the cross-product matrix: skew(a) b = a x b.
inline Matrix3d skew(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace quadcore
