#pragma once

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::rotors {

/// A first-order lag with different time constants for rising and falling values.
struct Lag {
  double up, down;  ///< s

  double constant(double from, double to) const { return to > from ? up : down; }
  /// Return the value after a time [s] that starts at `from` and approaches `to`.
  double after(double time, double from, double to) const {
    if (time == 0) return from;
    const double kept = elementary::exp(-time / constant(from, to));
    return kept * from + (1 - kept) * to;
  }
  /// Return the derivative of this value.
  double slope(double time, double from, double to) const {
    return (to - after(time, from, to)) / constant(from, to);
  }
};

}  // namespace quadcore::rotors
