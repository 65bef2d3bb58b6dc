#pragma once

#include "laws/shown_motion.hpp"

namespace quadcore::aerodynamic {

/// Add forces and reactions of all rotors to their loads, W rotors at once.
template <int W, bool has_32_registers = false>
void add_rotor_forces(const RotorForces& law, const laws::ShownMotion& shown);

}  // namespace quadcore::aerodynamic
