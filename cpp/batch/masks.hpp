#pragma once

#include "block_motion.hpp"

namespace quadcore::batch {

/// Where a comparison holds, all bits.
template <class T>
using Mask = laws::BitsOf<T>;

template <class T, class Comparison>
QUADCORE_LAW Mask<T> mask(const Comparison& comparison) {
  if constexpr (laws::lanes_of<T> == 1) {
    return -static_cast<std::int64_t>(comparison);
  } else {
    return comparison;
  }
}

/// How a step has left a pack of vehicles.
template <class T>
struct Outcome {
  T distance_squared, speed_squared, rate_squared, joint_rates_squared;
};

/// Vehicles that a step left where a flight may go on without looking closer.
template <class T>
QUADCORE_LAW Mask<T> is_sound(const Bounds& bounds, const Outcome<T>& left) {
  // By the bits, because the compiler may be told that numbers are finite.
  constexpr std::int64_t exponent = 0x7FF0000000000000;
  const T all =
      ((left.distance_squared + left.speed_squared) + left.rate_squared) + left.joint_rates_squared;
  const auto finite = (laws::bits(all) & exponent) != exponent;
  return mask<T>(finite) & mask<T>(left.distance_squared < bounds.distance_squared) &
         mask<T>(left.speed_squared < bounds.speed_squared) &
         mask<T>(left.rate_squared < bounds.rate_squared) &
         mask<T>(left.joint_rates_squared < bounds.rate_squared);
}

}  // namespace quadcore::batch
