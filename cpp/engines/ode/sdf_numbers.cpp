#include "sdf_numbers.hpp"

#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr int urdf_digits = 16, sdf_digits = 6;

double printed(double value, int digits) {
  // Whole numbers with few digits do not change, and most numbers are zeros and ones.
  if (std::abs(value) < 1e6 && value == std::trunc(value)) return value;
  return with_digits(value, digits);
}

Vector3d printed(const Vector3d& v, int digits) {
  return {printed(v.x(), digits), printed(v.y(), digits), printed(v.z(), digits)};
}

double rounded_component(double value) {
  return printed(std::round(printed(value, urdf_digits) * 1e6) / 1e6, sdf_digits);
}

/// Return the roll, pitch, yaw of a quaternion as in ignition::math.
Vector3d ignition_rpy(Quaterniond q) {
  const double length = std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  q = Quaterniond(q.w() / length, q.x() / length, q.y() / length, q.z() / length);
  const double w2 = q.w() * q.w(), x2 = q.x() * q.x(), y2 = q.y() * q.y(), z2 = q.z() * q.z();
  const double sin_pitch = -2 * (q.x() * q.z() - q.w() * q.y());
  const double pitch = elementary::asin(std::max(-1.0, std::min(1.0, sin_pitch)));
  constexpr double tolerance = 1e-15;
  for (const double sign : {1.0, -1.0}) {
    if (std::abs(sin_pitch - sign) < tolerance) {
      return {elementary::atan2(sign * 2 * (q.x() * q.y() - q.z() * q.w()), w2 - x2 + y2 - z2),
              pitch, 0};
    }
  }
  return {elementary::atan2(2 * (q.y() * q.z() + q.w() * q.x()), w2 - x2 - y2 + z2), pitch,
          elementary::atan2(2 * (q.x() * q.y() + q.w() * q.z()), w2 + x2 - y2 - z2)};
}

Pose rounded_pose(const Vector3d& xyz, const Vector3d& rpy) {
  const Quaterniond read = quaternion_from_rpy(printed(rpy, urdf_digits));
  return {sdf_vector(xyz), sdf_vector(ignition_rpy(read))};
}

}  // namespace

SdfPose SdfPose::operator*(const SdfPose& other) const {
  const Quaterniond& a = q;
  const Quaterniond& b = other.q;
  const Vector3d axis = a.vec(), once = axis.cross(other.xyz), twice = axis.cross(once);
  return {xyz + (other.xyz + 2 * a.w() * once + 2 * twice),
          Quaterniond(a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z(),
                      a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y(),
                      a.w() * b.y() - a.x() * b.z() + a.y() * b.w() + a.z() * b.x(),
                      a.w() * b.z() + a.x() * b.y() - a.y() * b.x() + a.z() * b.w())};
}

Vector3d urdf_rpy(const Quaterniond& q) {
  const double sin_pitch = -2 * (q.x() * q.z() - q.w() * q.y());
  if (sin_pitch <= -0.99999) return {0, -M_PI_2, 2 * elementary::atan2(q.x(), -q.y())};
  if (sin_pitch >= 0.99999) return {0, M_PI_2, 2 * elementary::atan2(-q.x(), q.y())};
  const double w2 = q.w() * q.w(), x2 = q.x() * q.x(), y2 = q.y() * q.y(), z2 = q.z() * q.z();
  return {elementary::atan2(2 * (q.y() * q.z() + q.w() * q.x()), w2 - x2 - y2 + z2),
          elementary::asin(sin_pitch),
          elementary::atan2(2 * (q.x() * q.y() + q.w() * q.z()), w2 + x2 - y2 - z2)};
}

double sdf_scalar(double value) { return printed(printed(value, urdf_digits), sdf_digits); }

Vector3d sdf_vector(const Vector3d& v) {
  return {rounded_component(v.x()), rounded_component(v.y()), rounded_component(v.z())};
}

Pose sdf_pose(const SdfPose& pose) { return rounded_pose(pose.xyz, ignition_rpy(pose.q)); }

Pose sdf_shape_pose(const SdfPose& pose) { return rounded_pose(pose.xyz, urdf_rpy(pose.q)); }

}  // namespace quadcore
