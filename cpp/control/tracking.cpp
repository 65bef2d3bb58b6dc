#include "tracking.hpp"

#include <cmath>

namespace quadcore::control {

Tracking::Tracking(const Belief& belief, const TrackingGains& g) : attitude_(belief, g), gains_(g) {
  position_p_ << g.kp_xy, g.kp_xy, g.kp_z;
  position_i_ << g.ki_xy, g.ki_xy, g.ki_z;
  position_d_ << g.kd_xy, g.kd_xy, g.kd_z;
}

Vector3d Tracking::acceleration(const Instant& instant, double* integral) const {
  const Reference& wanted = instant.wanted;
  const Vector3d error = wanted.position - instant.now.position;
  Vector3d a_W = position_p_.cwiseProduct(error) +
                 position_d_.cwiseProduct(wanted.velocity - instant.now.linear_velocity);
  if (gains_.feed_forward) a_W += wanted.acceleration;
  if (!gains_.integral) return a_W;
  for (int i = 0; i < 3; ++i) {
    // Nothing is summed that the rotors cannot follow, or beyond what the limit lets act.
    const double sum = integral[i] + instant.period * error[i];
    const bool grows = std::abs(sum) > std::abs(integral[i]);
    const bool acts = position_i_[i] * std::abs(sum) <= gains_.integral_limit;
    if (!grows || (acts && !instant.saturated)) integral[i] = sum;
    a_W[i] += position_i_[i] * integral[i];
  }
  return a_W;
}

Vector3d Tracking::force_W(const Instant& instant, const std::optional<FlatState>& flat,
                           const Vector3d& a_WF_W) const {
  Vector3d a_W = a_WF_W + Vector3d(0, 0, belief().gravity);
  if (flat) a_W += flat->a_FCcm_W;
  if (!gains_.drag) return belief().mass * a_W;
  const Odometry& now = instant.now;
  return belief().mass * a_W - belief().air_force_W(now.orientation.toRotationMatrix(),
                                                    now.linear_velocity, now.angular_velocity);
}

std::optional<FlatState> Tracking::fed_forward(const Instant& instant) const {
  if (!gains_.flat_rates) return {};
  return flat_state(instant.wanted, belief(), gains_.drag);
}

Vector3d Tracking::angular_acceleration(const Instant& instant,
                                        const std::optional<FlatState>& flat,
                                        const Vector3d& z_W) const {
  const Matrix3d R_WF = instant.now.orientation.toRotationMatrix();
  const Matrix3d R_WD = attitude_of(z_W, instant.wanted.yaw);
  const Quaterniond q_FD(Matrix3d(R_WF.transpose() * R_WD));
  const Vector3d& w_WF_F = instant.now.angular_velocity;
  if (!flat) return attitude_.angular_acceleration(q_FD, -w_WF_F);
  const Matrix3d R_FD = R_WF.transpose() * flat->R_WF;
  const Vector3d wanted_w_F = R_FD * flat->w_WF_F;
  const Vector3d wanted_dw_F = R_FD * flat->dw_WF_F - w_WF_F.cross(wanted_w_F);
  return attitude_.angular_acceleration(q_FD, wanted_w_F - w_WF_F) + wanted_dw_F;
}

Vector3d Tracking::torque(const Instant& instant, const Vector3d& dw_WF_F) const {
  return attitude_.torque(instant.now, instant.h_F, dw_WF_F);
}

}  // namespace quadcore::control
