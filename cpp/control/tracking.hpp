#pragma once

#include <utility>

#include "attitude_settings.hpp"
#include "numbers.hpp"
#include "tracking_formulas.hpp"

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

/// The gains as numbers for the control laws on SE(3).
class Tracking {
 public:
  Tracking(const ModelledVehicle& model, const TrackingGains& gains);

  const ControllerSwitches& switches() const { return switches_; }
  const TrackingNumbers<double>& numbers() const { return numbers_; }
  /// See WrenchController::feeds().
  WrenchController::Feeds feeds() const;
  /// Return function(TrackingFormulas), a demand.
  template <class Function>
  Demand demand(const ControllerInput& input, const Function& function) const {
    return call_with_numbers(input, feeds(), model_, [&](const InputNumbers<double>& numbers) {
      return function(TrackingFormulas<double>{switches_, numbers_, numbers});
    });
  }

 private:
  ModelledVehicle model_;
  ControllerSwitches switches_;
  TrackingNumbers<double> numbers_;
};

}  // namespace quadcore::control
