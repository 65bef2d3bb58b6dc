#pragma once

#include "laws/shown_motion.hpp"

namespace quadcore::aerodynamic {

/// Add forces and reactions of all rotors to their loads, in code for lanes of width W.
template <int W>
void add_rotor_forces(const RotorForces& law, const laws::ShownMotion& shown);

}  // namespace quadcore::aerodynamic
