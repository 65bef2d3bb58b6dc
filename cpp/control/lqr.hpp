#pragma once

#include "quadcore/control/control_law.hpp"

namespace quadcore::control {

/// A linear-quadratic regulator around the reference's flat state, optimal in hover, with
/// feed-forward of the reference (Bouabdallah, Noth, Siegwart, IROS 2004). The hovering vehicle
/// separates into four chains: integral, position, velocity, tilt and rate along x and along y;
/// integral, position and velocity along z; yaw and its rate.
class Lqr final : public ControlLaw {
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

  static constexpr std::size_t memory_size = 3;
  Feeds feeds() const override {
    return gains_.drag ? Feeds::flat_state_with_drag : Feeds::flat_state;
  }
  Demand demand(const LawInput& input, double* memory) const override;

 private:
  ModelledVehicle model_;
  Gains gains_;
  Eigen::Matrix<double, 1, 5> level_;   ///< gains of integral, position, velocity, tilt and rate
  Eigen::Matrix<double, 1, 3> height_;  ///< gains of integral, position and velocity
  Eigen::Matrix<double, 1, 2> yaw_;     ///< gains of yaw and its rate
};

}  // namespace quadcore::control
