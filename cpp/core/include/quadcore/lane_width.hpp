#pragma once

#include <cstddef>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Return the number of rotors that this processor evaluates at once for a vehicle with so many
/// rotors: 2, 4 or 8, limited by its registers and by the number of rotors. The environment
/// variable QUADCORE_LANES (1, 2, 4 or 8) overrides it. All widths give bit-identical results.
/// Throws InputError for another value of the variable.
int lane_width(std::size_t rotors);

}  // namespace quadcore
