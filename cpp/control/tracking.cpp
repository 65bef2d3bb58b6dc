#include "tracking.hpp"

#include <cmath>

namespace quadcore::control {

Tracking::Tracking(const ModelledVehicle& model, const TrackingGains& g)
    : attitude_(model, g), gains_(g) {
  position_p_ << g.kp_xy, g.kp_xy, g.kp_z;
  position_i_ << g.ki_xy, g.ki_xy, g.ki_z;
  position_d_ << g.kd_xy, g.kd_xy, g.kd_z;
}

Vector3d Tracking::acceleration(const LawInput& input, double* integral) const {
  const Reference& wanted = input.wanted;
  const Vector3d error = wanted.position - input.now.position;
  Vector3d a_W = position_p_.cwiseProduct(error) +
                 position_d_.cwiseProduct(wanted.velocity - input.now.linear_velocity);
  if (gains_.feed_forward) a_W += wanted.acceleration;
  if (!gains_.integral) return a_W;
  for (int i = 0; i < 3; ++i) {
    // Do not integrate demands that the rotors cannot follow, or beyond the limit.
    const double sum = integral[i] + input.period * error[i];
    const bool grows = std::abs(sum) > std::abs(integral[i]);
    const bool acts = position_i_[i] * std::abs(sum) <= gains_.integral_limit;
    if (!grows || (acts && !input.saturated)) integral[i] = sum;
    a_W[i] += position_i_[i] * integral[i];
  }
  return a_W;
}

Vector3d Tracking::force_W(const LawInput& input, const std::optional<FlatState>& flat,
                           const Vector3d& a_WF_W) const {
  Vector3d a_W = a_WF_W + Vector3d(0, 0, model().gravity);
  if (flat) a_W += flat->a_FCcm_W;
  if (!gains_.drag) return model().mass * a_W;
  const Odometry& now = input.now;
  return model().mass * a_W - model().air_force_W(now.orientation.toRotationMatrix(),
                                                  now.linear_velocity, now.angular_velocity);
}

ControlLaw::Feeds Tracking::feeds() const {
  using Feeds = ControlLaw::Feeds;
  if (!gains_.flat_rates) return Feeds::nothing;
  return gains_.drag ? Feeds::flat_state_with_drag : Feeds::flat_state;
}

std::optional<FlatState> Tracking::fed_forward(const LawInput& input) const {
  if (!gains_.flat_rates) return {};
  if (input.flat) return *input.flat;
  return flat_state(input.wanted, model(), gains_.drag);
}

Vector3d Tracking::angular_acceleration(const LawInput& input, const std::optional<FlatState>& flat,
                                        const Vector3d& z_W) const {
  const Matrix3d R_WF = input.now.orientation.toRotationMatrix();
  const Matrix3d R_WD = attitude_of(z_W, flat ? flat->across_W : across_yaw(input.wanted.yaw));
  const Quaterniond q_FD(Matrix3d(R_WF.transpose() * R_WD));
  const Vector3d& w_WF_F = input.now.angular_velocity;
  if (!flat) return attitude_.angular_acceleration(q_FD, -w_WF_F);
  const Matrix3d R_FD = R_WF.transpose() * flat->R_WF;
  const Vector3d wanted_w_F = R_FD * flat->w_WF_F;
  const Vector3d wanted_dw_F = R_FD * flat->dw_WF_F - w_WF_F.cross(wanted_w_F);
  return attitude_.angular_acceleration(q_FD, wanted_w_F - w_WF_F) + wanted_dw_F;
}

Vector3d Tracking::torque(const LawInput& input, const Vector3d& dw_WF_F) const {
  return attitude_.torque(input.now, input.h_F, dw_WF_F);
}

}  // namespace quadcore::control
