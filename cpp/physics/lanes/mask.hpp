#pragma once

#include "pack.hpp"

namespace quadcore::laws {

/// All bits are set where a comparison is true.
template <class T>
using Mask = BitsOf<T>;

template <class T, class Comparison>
QUADCORE_LAW Mask<T> mask(const Comparison& comparison) {
  if constexpr (lanes_of<T> == 1) {
    return -static_cast<std::int64_t>(comparison);
  } else {
    return comparison;
  }
}

}  // namespace quadcore::laws
