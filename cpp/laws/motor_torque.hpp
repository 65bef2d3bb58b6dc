#pragma once

#include "quadcore/lane_laws.hpp"
#include "rotors.hpp"

namespace quadcore::laws {

/// Torque of the motors' joints on a pack of rotors, from rotor i on [N m].
template <class T>
QUADCORE_LAW T motor_torque(const MotorTorques& law, std::size_t i, T rate) {
  const double* rows = law.memory + rotor_offset(MemoryRow::count, i);
  const auto memory = [rows](std::size_t row) { return load<T>(rows + row * widest_lanes); };
  const T error = rate - memory(MemoryRow::target);
  return memory(MemoryRow::active) * (-law.kp * error + memory(MemoryRow::sampled_torque));
}

}  // namespace quadcore::laws
