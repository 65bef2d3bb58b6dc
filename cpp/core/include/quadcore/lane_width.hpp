#pragma once

#include <cstddef>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// How many rotors this processor should take at once in a vehicle of so many: 2, 4 or 8, no more
/// than it has registers for and no more than are needed. The environment variable QUADCORE_LANES
/// (1, 2, 4 or 8) asks for another number. Every width gives the same bytes. Throws InputError on
/// another value of that variable.
int lane_width(std::size_t rotors);

}  // namespace quadcore
