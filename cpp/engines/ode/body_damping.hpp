#pragma once

#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// The part of a body's velocity or rate that <dampingFactor> leaves in a step. ODE's damping
/// spares what is slower than a threshold.
inline double part_left_by_damping(const Vector3d& velocity, double factor) {
  constexpr double slow = 0.01;  // m/s, rad/s
  return velocity.squaredNorm() > slow * slow ? 1 - factor : 1;
}

}  // namespace quadcore
