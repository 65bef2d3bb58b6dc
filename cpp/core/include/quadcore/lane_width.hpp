#pragma once

#include <cstddef>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Code for the rotors of a vehicle.
struct RotorCode {
  int width;              ///< number of rotors that it evaluates at once
  bool has_32_registers;  ///< whether it uses the 32 registers of AVX-512 for packs of four
};

/// Return the code that this processor runs for a vehicle with so many rotors. The width is 2, 4 or
/// 8, limited by its registers and by the number of rotors. The environment variable QUADCORE_LANES
/// (1, 2, 4 or 8) overrides it; 4 then means the 16 registers of AVX2. All codes give bit-identical
/// results. Throws InputError for another value of the variable.
RotorCode rotor_code(std::size_t rotors);

/// Return the width of rotor_code().
inline int lane_width(std::size_t rotors) { return rotor_code(rotors).width; }

}  // namespace quadcore
