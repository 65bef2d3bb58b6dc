#pragma once

#include <optional>
#include <utility>

#include "attitude_settings.hpp"
#include "quadcore/control/flat_state.hpp"
#include "quadcore/control/law.hpp"

namespace quadcore::control {

/// What the laws on rotations have in common: gains, and the loops around position and attitude.
struct TrackingGains : AttitudeGains {
  double kp_xy, ki_xy, kd_xy, kp_z, ki_z, kd_z;
  double integral_limit;
  bool feed_forward, flat_rates, integral;
};

/// The settings of gains that have those for a base.
template <class G>
Settings<G> with_tracking(Settings<G> settings) {
  using T = TagSpec;
  const auto gain = [](const char* name, const char* unit, const char* fallback,
                       const char* meaning) {
    return T::number(name, unit, fallback, meaning).at_least(0);
  };
  const Settings<G> tracking = {
      {gain("kp_xy", "1/s^2", "9", "of the position along x and y"), &G::kp_xy},
      {gain("ki_xy", "1/s^3", "6", "of its integral"), &G::ki_xy},
      {gain("kd_xy", "1/s", "5.4", "of the velocity along x and y"), &G::kd_xy},
      {gain("kp_z", "1/s^2", "16", "of the position along z"), &G::kp_z},
      {gain("ki_z", "1/s^3", "12", "of its integral"), &G::ki_z},
      {gain("kd_z", "1/s", "8", "of the velocity along z"), &G::kd_z},
      {gain("integral_limit", "m/s^2", "1.5", "largest acceleration along an axis by the integral"),
       &G::integral_limit},
      {T::flag("feed_forward", "true", "the acceleration of the reference"), &G::feed_forward},
      {T::flag("flat_rates", "true",
               "angular velocity and acceleration that the reference asks for"),
       &G::flat_rates},
      {T::flag("integral", "true", "of the error of position"), &G::integral},
  };
  settings.insert(settings.end(), tracking.begin(), tracking.end());
  return with_attitude<G>(std::move(settings));
}

class Tracking {
 public:
  Tracking(const Belief& belief, const TrackingGains& gains);

  const Belief& belief() const { return attitude_.belief(); }

  /// What the reference asks for, if it is to be fed forward.
  std::optional<FlatState> fed_forward(const Instant& instant) const;
  /// Acceleration that makes up for the errors of position and velocity, in W [m/s^2].
  /// \param integral  three numbers of memory [m s]
  Vector3d acceleration(const Instant& instant, double* integral) const;
  /// Force of the rotors that accelerates the origin of F so, in W [N].
  Vector3d force_W(const Instant& instant, const std::optional<FlatState>& flat,
                   const Vector3d& a_WF_W) const;
  /// Angular acceleration that turns z of F into a direction and x to the yaw, in F [rad/s^2].
  Vector3d angular_acceleration(const Instant& instant, const std::optional<FlatState>& flat,
                                const Vector3d& z_W) const;
  /// Torque of the rotors that turns the vehicle so, in F [N m].
  Vector3d torque(const Instant& instant, const Vector3d& dw_WF_F) const;

 private:
  AttitudeLoop attitude_;
  TrackingGains gains_;
  Vector3d position_p_, position_i_, position_d_;
};

}  // namespace quadcore::control
