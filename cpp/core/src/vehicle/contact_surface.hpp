#pragma once

#include <algorithm>

#include "quadcore/plugin/model.hpp"

/// \file
/// Contact parameters of two surfaces, as in Gazebo 11: springs act in series, dampers add up, and
/// the smaller friction coefficient counts.

namespace quadcore {

inline double joint_stiffness(const Surface& one, const Surface& other) {
  return 1 / (1 / one.kp + 1 / other.kp);
}
inline double joint_damping(const Surface& one, const Surface& other) { return one.kd + other.kd; }
inline double joint_mu1(const Surface& one, const Surface& other) {
  return std::min(one.mu1, other.mu1);
}
inline double joint_mu2(const Surface& one, const Surface& other) {
  return std::min(one.mu2, other.mu2);
}

}  // namespace quadcore
