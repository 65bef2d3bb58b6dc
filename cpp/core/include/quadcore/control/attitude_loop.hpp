#pragma once

#include "quadcore/control/belief.hpp"
#include "quadcore/messages.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

using messages::Odometry;

struct AttitudeGains {
  double kr_rp, kw_rp, kr_yaw, kw_yaw;
  bool drag, gyroscopic;
};

/// The settings of gains that have those for a base.
template <class G>
Settings<G> with_attitude(Settings<G> settings) {
  using T = TagSpec;
  const Settings<G> attitude = {
      {T::number("kr_rp", "1/s^2", "300", "of the error of roll and pitch").at_least(0), &G::kr_rp},
      {T::number("kw_rp", "1/s", "30", "of the error of their rates").at_least(0), &G::kw_rp},
      {T::number("kr_yaw", "1/s^2", "3", "of the error of yaw").at_least(0), &G::kr_yaw},
      {T::number("kw_yaw", "1/s", "3", "of the error of its rate").at_least(0), &G::kw_yaw},
      {T::flag("drag", "true", "makes up for the believed force and torque of the air"), &G::drag},
      {T::flag("gyroscopic", "true", "makes up for the rotors' gyroscopic torque"), &G::gyroscopic},
  };
  settings.insert(settings.end(), attitude.begin(), attitude.end());
  return settings;
}

/// The loop around the attitude.
class AttitudeLoop {
 public:
  AttitudeLoop(const Belief& belief, const AttitudeGains& gains);

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
