#pragma once

#include "quadcore/control/modelled_vehicle.hpp"
#include "quadcore/plugin/messages.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

using messages::Odometry;

/// Gains of the angular acceleration p e + d (w_D - w) in F. Here e is 2 sign(q_w) q_vec of the
/// wanted orientation relative to F, p = (kr_rp, kr_rp, kr_yaw) and d = (kw_rp, kw_rp, kw_yaw).
struct AttitudeGains {
  double kr_rp, kw_rp, kr_yaw, kw_yaw;
  /// \var kr_rp
  /// Gain of the attitude error about x and y of F [1/s^2].
  /// \var kw_rp
  /// Gain of the angular velocity error about x and y of F [1/s].
  /// \var kr_yaw
  /// Gain of the attitude error about z of F [1/s^2].
  /// \var kw_yaw
  /// Gain of the angular velocity error about z of F [1/s].

  /// Whether to compensate the aerodynamic torque.
  bool drag, gyroscopic;  ///< whether to compensate the rotors' gyroscopic torque
};

/// Attitude controller.
class AttitudeLoop {
 public:
  /// Copies both arguments.
  AttitudeLoop(const ModelledVehicle& model, const AttitudeGains& gains);

  /// Return the modelled vehicle.
  const ModelledVehicle& model() const { return model_; }

  /// Return the angular acceleration that corrects errors, in F [rad/s^2].
  /// \param q_FD       wanted orientation relative to F
  /// \param w_error_F  wanted minus actual angular velocity [rad/s]
  Vector3d angular_acceleration(const Quaterniond& q_FD, const Vector3d& w_error_F) const;
  /// Return the angular acceleration that corrects only an angular velocity error.
  Vector3d angular_acceleration(const Vector3d& w_error_F) const;
  /// Return the torque of the rotors for an angular acceleration, in F [N m].
  /// \param now  odometry with the velocity in W
  /// \param h_F  angular momentum of the rotors, relative to the frame [kg m^2/s]
  Vector3d torque(const Odometry& now, const Vector3d& h_F, const Vector3d& dw_WF_F) const;

 private:
  ModelledVehicle model_;
  AttitudeGains gains_;
};

}  // namespace control
}  // namespace quadcore
