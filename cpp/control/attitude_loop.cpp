#include "quadcore/control/attitude_loop.hpp"

#include "quadcore/control/flat_state.hpp"

namespace quadcore::control {

AttitudeLoop::AttitudeLoop(const ModelledVehicle& model, const AttitudeGains& g)
    : model_(model),
      drag_(g.drag),
      gyroscopic_(g.gyroscopic),
      p_(g.kr_rp, g.kr_rp, g.kr_yaw),
      d_(g.kw_rp, g.kw_rp, g.kw_yaw) {}

Vector3d AttitudeLoop::angular_acceleration(const Quaterniond& q_FD,
                                            const Vector3d& w_error_F) const {
  // 2 sign(q_w) q_vec grows up to half a turn (Mayhew, Sanfelice, Teel, IEEE TAC 2011), while the
  // error from rotation matrices vanishes there.
  const Vector3d error_F = (q_FD.w() < 0 ? -2 : 2) * q_FD.vec();
  return p_.cwiseProduct(error_F) + angular_acceleration(w_error_F);
}

Vector3d AttitudeLoop::torque(const Odometry& now, const Vector3d& h_F,
                              const Vector3d& dw_WF_F) const {
  Vector3d tau_air_F = Vector3d::Zero();
  if (drag_) {
    tau_air_F = model_.air_torque_F(now.orientation.conjugate() * now.linear_velocity,
                                    now.angular_velocity);
  }
  const Vector3d felt_h_F = gyroscopic_ ? h_F : Vector3d(Vector3d::Zero());
  return torque_for(model_, dw_WF_F, now.angular_velocity, felt_h_F, tau_air_F);
}

}  // namespace quadcore::control
