#pragma once

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::rotors {

/// A lag of first order whose time constant is one upwards and another downwards.
struct Lag {
  double up, down;  ///< s

  double constant(double from, double to) const { return to > from ? up : down; }
  /// What follows `to` from `from` on, after a time [s].
  double after(double time, double from, double to) const {
    if (time == 0) return from;
    const double kept = elementary::exp(-time / constant(from, to));
    return kept * from + (1 - kept) * to;
  }
  /// Its derivative then.
  double slope(double time, double from, double to) const {
    return (to - after(time, from, to)) / constant(from, to);
  }
};

}  // namespace quadcore::rotors
