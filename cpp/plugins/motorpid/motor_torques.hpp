#pragma once

#include "quadcore/rotor_layout.hpp"

namespace quadcore::motorpid {

/// Rows of what the rotors' controllers remember, a column for each rotor; all 0 for rotors that
/// are somebody else's and before the first command.
struct MemoryRow {
  enum : std::size_t { active, target, error_sum, last_error, sampled_torque, count };
};

/// The part of the law that is continuous: -kp (W - W_target) and the torque sampled at the start
/// of the step (thesis appendix A.4), in slowed units [N m].
struct MotorTorques {
  RotorLanes rotors;
  const double* memory;
  double kp;
};

/// Adds the torques of all rotors to their loads, W rotors at once.
template <int W>
void add_motor_torques(const MotorTorques& law);

}  // namespace quadcore::motorpid
