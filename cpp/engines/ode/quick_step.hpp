#pragma once

#include <ode/ode.h>

#include <vector>

#include "body_state.hpp"

namespace quadcore {

/// dWorldQuickStep with a result that depends on the world alone. QuickStep shuffles its rows by a
/// generator that the whole process shares: it is seeded before each step, and steps of several
/// threads take turns.
void seeded_quick_step(dWorldID world, double dt);

/// A step with contacts as Gazebo 11 takes it: solved twice from the same state, poses moving with
/// the full correction of the penetration, velocities from a second solve whose correction is
/// capped. (The direct solver fails on such steps.)
class SplitStep {
 public:
  explicit SplitStep(std::size_t body_count) : memory_(body_count) {}
  void step(dWorldID world, const std::vector<dBodyID>& bodies, double dt);

 private:
  struct Memory {
    double pose_before[pose_size], velocity_before[velocity_size];
    double force[3], torque[3];
    double pose_after[pose_size];
  };
  std::vector<Memory> memory_;
};

}  // namespace quadcore
