#pragma once

#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// Return the fraction of a body's velocity or angular velocity that remains after a step with
/// <dampingFactor>. ODE does not damp velocities below a threshold.
inline double part_left_by_damping(const Vector3d& velocity, double factor) {
  constexpr double slow = 0.01;  // m/s, rad/s
  return velocity.squaredNorm() > slow * slow ? 1 - factor : 1;
}

}  // namespace quadcore
