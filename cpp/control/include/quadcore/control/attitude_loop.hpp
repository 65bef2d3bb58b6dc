#pragma once

#include "quadcore/control/belief.hpp"
#include "quadcore/plugin/messages.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

using messages::Odometry;

/// Gains of the angular acceleration p e + d (w_D - w), in F: e being 2 sign(q_w) q_vec of the
/// wanted orientation as seen from F, p = (kr_rp, kr_rp, kr_yaw) and d = (kw_rp, kw_rp, kw_yaw).
struct AttitudeGains {
  double kr_rp, kw_rp, kr_yaw, kw_yaw;
  /// \var kr_rp
  /// Of the error of the attitude about x and y of F [1/s^2].
  /// \var kw_rp
  /// Of the error of the angular velocity about x and y of F [1/s].
  /// \var kr_yaw
  /// Of the error of the attitude about z of F [1/s^2].
  /// \var kw_yaw
  /// Of the error of the angular velocity about z of F [1/s].

  /// Whether the torque of the air is made up for.
  bool drag, gyroscopic;  ///< whether the rotors' gyroscopic torque is
};

/// The loop around the attitude.
class AttitudeLoop {
 public:
  /// Copies both.
  AttitudeLoop(const Belief& belief, const AttitudeGains& gains);

  /// The vehicle that it was made for.
  const Belief& belief() const { return belief_; }

  /// Angular acceleration that makes up for errors, in F [rad/s^2].
  /// \param q_FD       wanted orientation as seen from F
  /// \param w_error_F  wanted angular velocity less that of F [rad/s]
  Vector3d angular_acceleration(const Quaterniond& q_FD, const Vector3d& w_error_F) const;
  /// Angular acceleration that makes up for an error of the angular velocity alone.
  Vector3d angular_acceleration(const Vector3d& w_error_F) const {
    return d_.cwiseProduct(w_error_F);
  }
  /// Torque of the rotors that turns the vehicle so, in F [N m].
  /// \param now  with the velocity in W
  /// \param h_F  angular momentum of the rotors, relative to the frame [kg m^2/s]
  Vector3d torque(const Odometry& now, const Vector3d& h_F, const Vector3d& dw_WF_F) const;

 private:
  Belief belief_;
  bool drag_, gyroscopic_;
  Vector3d p_, d_;
};

}  // namespace control
}  // namespace quadcore
