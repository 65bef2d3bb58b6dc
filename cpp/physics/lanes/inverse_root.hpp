#pragma once

#include "pack.hpp"

namespace quadcore::laws {

/// Return the inverse of the square root of a positive number. The root and the reciprocal, which
/// take longest, do not wait for each other.
template <class T>
QUADCORE_LAW T inverse_root(T a) {
  return square_root(a) * (1 / a);
}

}  // namespace quadcore::laws
