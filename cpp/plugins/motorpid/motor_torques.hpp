#pragma once

#include "quadcore/lane_laws.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore::motorpid {

/// Add the torques of all rotors to their loads, in code for lanes of width W.
template <int W>
void add_motor_torques(const MotorTorques& law, const RotorLanes& rotors);

}  // namespace quadcore::motorpid
