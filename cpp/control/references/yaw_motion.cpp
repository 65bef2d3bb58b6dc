#include "references/yaw_motion.hpp"

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {

void YawMotion::turn(double t, Reference& wanted, double standing) const {
  constexpr double slowest = 1e-6;  // m/s; below it, rounding errors dominate the direction
  wanted.yaw = yaw + yaw_rate * t;
  wanted.yaw_rate = yaw_rate;
  wanted.yaw_acceleration = 0;
  if (!along) return;
  const auto cross = [](const Vector3d& a, const Vector3d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const Vector3d &v = wanted.velocity, &a = wanted.acceleration, &j = wanted.jerk;
  const double squared = v.x() * v.x() + v.y() * v.y();
  if (squared < slowest * slowest) {
    wanted.yaw += standing;
    return;
  }
  // psi = atan2(vy, vx), psi' = (v x a)/v^2, psi'' = (v x j)/v^2 - 2 psi' (v . a)/v^2
  const double turning = cross(v, a) / squared;
  wanted.yaw += elementary::atan2(v.y(), v.x());
  wanted.yaw_rate += turning;
  wanted.yaw_acceleration +=
      (cross(v, j) - 2 * turning * (v.x() * a.x() + v.y() * a.y())) / squared;
}

}  // namespace quadcore::control
