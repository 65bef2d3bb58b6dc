#pragma once

#include "lqr_formulas.hpp"
#include "numbers.hpp"

namespace quadcore::control {

/// A linear-quadratic regulator around the reference's flat state, optimal in hover, with
/// feed-forward of the reference (Bouabdallah, Noth, Siegwart, IROS 2004). The hovering vehicle
/// separates into four chains: integral, position, velocity, tilt and rate along x and along y;
/// integral, position and velocity along z; yaw and its rate.
class Lqr final : public WrenchController {
 public:
  struct Gains {
    double q_integral, q_position, q_velocity, q_tilt, q_rate, r_tilt;
    double q_height_integral, q_height, q_climb, r_thrust;
    double q_yaw, q_yaw_rate, r_yaw;
    double sum_limit;
    bool integral, feed_forward, drag, gyroscopic, flat_rates;
  };
  static const Settings<Gains>& settings();

  Lqr(const ModelledVehicle& model, const Gains& gains);

  static constexpr std::size_t memory_size = size_of<LqrMemory>;
  Feeds feeds() const override;
  Demand demand(const ControllerInput& input, double* memory) const override;
  std::shared_ptr<const LaneWrenchController> in_lanes(double period) const override;

 private:
  Demand follow(const ControllerInput& input, double* memory) const;

  ModelledVehicle model_;
  ControllerSwitches switches_;
  LqrNumbers<double> numbers_;
};

}  // namespace quadcore::control
