#pragma once

#include "quadcore/lane_laws.hpp"
#include "rotors.hpp"

namespace quadcore::laws {

/// Return the torque of a motor's joint on its rotor, thesis appendix A.4 [N m].
/// \param active   remaining fraction of the torque
/// \param target   target of the joint's rate [rad/s]
/// \param sampled  torque of integral and derivative [N m]
template <class T, class K>
QUADCORE_LAW T motor_torque(T active, K kp, T target, T sampled, T rate) {
  const T error = rate - target;
  return active * (-kp * error + sampled);
}

/// Return the torques of a pack of rotors, starting at rotor i.
template <class T>
QUADCORE_LAW T motor_torque(const MotorTorques& law, std::size_t i, T rate) {
  const double* rows = law.memory + rotor_offset(MemoryRow::count, i);
  const auto memory = [rows](std::size_t row) { return load<T>(rows + row * widest_lanes); };
  return motor_torque(memory(MemoryRow::active), law.kp, memory(MemoryRow::target),
                      memory(MemoryRow::sampled_torque), rate);
}

}  // namespace quadcore::laws
