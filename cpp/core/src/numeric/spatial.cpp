#include "quadcore/plugin/spatial.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore {

Quaterniond quaternion_from_rpy(const Vector3d& rpy) {
  const auto [sr, cr] = elementary::sincos(rpy.x() / 2);
  const auto [sp, cp] = elementary::sincos(rpy.y() / 2);
  const auto [sy, cy] = elementary::sincos(rpy.z() / 2);
  return Quaterniond(cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                     cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy)
      .normalized();
}

Vector3d rpy_from_quaternion(const Quaterniond& q) {
  const Matrix3d R = q.toRotationMatrix();
  const double sin_pitch = std::clamp(-R(2, 0), -1.0, 1.0);
  const double pitch = elementary::asin(sin_pitch);
  // At a pitch of +-90 degrees, roll and yaw rotate about the same axis; yaw takes the whole
  // rotation.
  if (std::abs(sin_pitch) > 1 - 1e-12) return {0, pitch, elementary::atan2(-R(0, 1), R(1, 1))};
  return {elementary::atan2(R(2, 1), R(2, 2)), pitch, elementary::atan2(R(1, 0), R(0, 0))};
}

Quaterniond quaternion_about(const Vector3d& axis, double angle) {
  const auto [s, c] = elementary::sincos(angle / 2);
  return {c, s * axis.x(), s * axis.y(), s * axis.z()};
}

Pose Pose::operator*(const Pose& other) const {
  const Quaterniond q = rotation();
  return {xyz + q * other.xyz, rpy_from_quaternion(q * other.rotation())};
}

}  // namespace quadcore
