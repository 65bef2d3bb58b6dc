#pragma once

#include <algorithm>

#include "quadcore/plugin/model.hpp"

/// \file
/// Contact parameters of the ground, measured in the running Gazebo 11. Springs act in series,
/// dampers add up, and the smaller friction coefficient counts.

namespace quadcore::ground {

constexpr double stiffness = 1e12;  // N/m
constexpr double damping = 1;       // N s/m
constexpr double mu1 = 100, mu2 = 50;

inline double stiffness_with(const Surface& surface) {
  return 1 / (1 / surface.kp + 1 / stiffness);
}
inline double damping_with(const Surface& surface) { return surface.kd + damping; }
inline double mu1_with(const Surface& surface) { return std::min(surface.mu1, mu1); }
inline double mu2_with(const Surface& surface) { return std::min(surface.mu2, mu2); }

}  // namespace quadcore::ground
