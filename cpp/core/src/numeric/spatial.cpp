#include "quadcore/plugin/spatial.hpp"

#include "laws/angles.hpp"
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
  const laws::Vec3<double> rpy = laws::roll_pitch_yaw(laws::matrix(R.data()));
  return {rpy.x, rpy.y, rpy.z};
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
