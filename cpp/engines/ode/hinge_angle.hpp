#pragma once

#include "lanes/quaternion.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore {

/// Return the angle of a hinge for ODE's stops (getHingeAngle()) [rad]: the whole rotation angle of
/// the child from angle zero, with the sign of its part about the axis.
QUADCORE_LAW double hinge_angle(const laws::Quaternion<double>& q_WC,
                                const laws::Quaternion<double>& q_WP,
                                const laws::Quaternion<double>& q_PC_at_zero,
                                const laws::Vec3<double>& axis_C) {
  constexpr double pi = 3.14159265358979323846;
  const laws::Quaternion<double> at_zero = q_WP * q_PC_at_zero;
  const laws::Quaternion<double> back =
      laws::Quaternion<double>{-q_WC.x, -q_WC.y, -q_WC.z, q_WC.w} * at_zero;
  const laws::Vec3<double> v{back.x, back.y, back.z};
  const double sine = laws::square_root(laws::dot(v, v));
  const double cosine = laws::dot(v, axis_C) >= 0 ? back.w : -back.w;
  const double angle = 2 * elementary::atan2(sine, cosine);  // in [0, 2 pi]
  return angle > pi ? 2 * pi - angle : -angle;
}

}  // namespace quadcore
