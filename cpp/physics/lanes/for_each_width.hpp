#pragma once

namespace quadcore::laws {

/// One function compiled for each lane width.
template <class Function>
struct ForEachWidth {
  Function *one, *two, *four, *eight;

  Function* operator[](int width) const {
    return width == 8 ? eight : width == 4 ? four : width == 2 ? two : one;
  }
};

}  // namespace quadcore::laws
