#pragma once

#include "quadcore/control/law.hpp"

namespace quadcore::control {

/// A linear regulator around the reference's flat state, optimal for the vehicle in hover, which
/// falls apart into four chains: along x and y integral, position, velocity, tilt, rate; along z
/// integral, position, velocity; yaw and its rate (Bouabdallah, Noth, Siegwart, IROS 2004, with the
/// reference's attitude and what it asks for fed forward).
class Lqr final : public Law {
 public:
  struct Gains {
    double q_integral, q_position, q_velocity, q_tilt, q_rate, r_tilt;
    double q_height_integral, q_height, q_climb, r_thrust;
    double q_yaw, q_yaw_rate, r_yaw;
    double sum_limit;
    bool integral, feed_forward, drag, gyroscopic, flat_rates;
  };
  static const Settings<Gains>& settings();

  Lqr(const Belief& belief, const Gains& gains);

  static constexpr std::size_t memory_size = 3;
  Demand demand(const Instant& instant, double* memory) const override;

 private:
  Belief belief_;
  Gains gains_;
  Eigen::Matrix<double, 1, 5> level_;   ///< of integral, position, velocity, tilt and rate
  Eigen::Matrix<double, 1, 3> height_;  ///< of integral, position and velocity
  Eigen::Matrix<double, 1, 2> yaw_;     ///< of yaw and its rate
};

}  // namespace quadcore::control
