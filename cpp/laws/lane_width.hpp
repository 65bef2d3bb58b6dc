#pragma once

#include <cstddef>

namespace quadcore::laws {

/// One function, compiled for each width of lanes.
template <class Function>
struct ForEachWidth {
  Function *one, *two, *four, *eight;

  Function* operator[](int width) const {
    return width == 8 ? eight : width == 4 ? four : width == 2 ? two : one;
  }
};

/// How many rotors this processor should take at once in a vehicle of so many: 2, 4 or 8, no more
/// than it has registers for and no more than are needed. The environment variable QUADCORE_LANES
/// (1, 2, 4 or 8) asks for another number. Every width gives the same bytes. Throws InputError on
/// another value of that variable.
int lane_width(std::size_t rotors);

}  // namespace quadcore::laws
