#pragma once

#include <optional>
#include <utility>

#include "attitude_settings.hpp"
#include "quadcore/control/control_law.hpp"
#include "quadcore/control/flat_state.hpp"

namespace quadcore::control {

/// Common parts of the controllers on SE(3): gains, position control and attitude control.
struct TrackingGains : AttitudeGains {
  double kp_xy, ki_xy, kd_xy, kp_z, ki_z, kd_z;
  double integral_limit;
  bool feed_forward, flat_rates, integral;
};

/// Add the tracking gains to the settings of a class derived from TrackingGains.
template <class G>
Settings<G> with_tracking(Settings<G> settings) {
  using T = TagSpec;
  const auto gain = [](const char* name, const char* unit, const char* fallback,
                       const char* meaning) {
    return T::number(name, unit, fallback, meaning).at_least(0);
  };
  const Settings<G> tracking = {
      {gain("kp_xy", "1/s^2", "9", "gain of the position error along x and y"), &G::kp_xy},
      {gain("ki_xy", "1/s^3", "6", "gain of the integral of the position error along x and y"),
       &G::ki_xy},
      {gain("kd_xy", "1/s", "5.4", "gain of the velocity error along x and y"), &G::kd_xy},
      {gain("kp_z", "1/s^2", "16", "gain of the position error along z"), &G::kp_z},
      {gain("ki_z", "1/s^3", "12", "gain of the integral of the position error along z"), &G::ki_z},
      {gain("kd_z", "1/s", "8", "gain of the velocity error along z"), &G::kd_z},
      {gain("integral_limit", "m/s^2", "1.5", "maximum acceleration along an axis by the integral"),
       &G::integral_limit},
      {T::flag("feed_forward", "true", "feeds the reference's acceleration forward"),
       &G::feed_forward},
      {T::flag("flat_rates", "true",
               "feeds the reference's angular velocity and acceleration forward"),
       &G::flat_rates},
      {T::flag("integral", "true", "integrates the position error"), &G::integral},
  };
  settings.insert(settings.end(), tracking.begin(), tracking.end());
  return with_attitude<G>(std::move(settings));
}

class Tracking {
 public:
  Tracking(const ModelledVehicle& model, const TrackingGains& gains);

  const ModelledVehicle& model() const { return attitude_.model(); }

  /// See ControlLaw::feeds().
  ControlLaw::Feeds feeds() const;
  /// Return the reference's flat state if it is fed forward.
  std::optional<FlatState> fed_forward(const LawInput& input) const;
  /// Return the acceleration that corrects position and velocity errors, in W [m/s^2].
  /// \param integral  three memory values [m s]
  Vector3d acceleration(const LawInput& input, double* integral) const;
  /// Return the force of the rotors for an acceleration of the origin of F, in W [N].
  Vector3d force_W(const LawInput& input, const std::optional<FlatState>& flat,
                   const Vector3d& a_WF_W) const;
  /// Return the angular acceleration that rotates z of F to a direction and x to the yaw, in F
  /// [rad/s^2].
  Vector3d angular_acceleration(const LawInput& input, const std::optional<FlatState>& flat,
                                const Vector3d& z_W) const;
  /// Return the torque of the rotors for an angular acceleration, in F [N m].
  Vector3d torque(const LawInput& input, const Vector3d& dw_WF_F) const;

 private:
  AttitudeLoop attitude_;
  TrackingGains gains_;
  Vector3d position_p_, position_i_, position_d_;
};

}  // namespace quadcore::control
