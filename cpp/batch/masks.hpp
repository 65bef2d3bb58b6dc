#pragma once

#include "block_motion.hpp"
#include "lanes/mask.hpp"

namespace quadcore::batch {

using laws::Mask;
using laws::mask;

/// Result of a step for a pack of vehicles.
template <class T>
struct Outcome {
  T distance_squared, speed_squared, rate_squared, joint_rates_squared;
};

/// Return the vehicles that can continue without further checks.
template <class T>
QUADCORE_LAW Mask<T> is_sound(const Bounds& bounds, const Outcome<T>& left) {
  // Test the bits, because compiler options may assume finite numbers.
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
