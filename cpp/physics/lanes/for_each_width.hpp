#pragma once

#include "quadcore/lane_width.hpp"

namespace quadcore::laws {

/// One function compiled for each lane width.
template <class Function>
struct ForEachWidth {
  Function *one, *two, *four, *eight;

  Function* operator[](int width) const {
    return width == 8 ? eight : width == 4 ? four : width == 2 ? two : one;
  }
};

/// The same for the rotors of a vehicle, where packs of four may also use 32 registers.
template <class Function>
struct ForRotors {
  ForEachWidth<Function> widths;
  Function* four_of_32;

  Function* operator[](const RotorCode& code) const {
    return code.has_32_registers ? four_of_32 : widths[code.width];
  }
};

}  // namespace quadcore::laws
