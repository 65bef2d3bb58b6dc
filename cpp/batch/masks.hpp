#pragma once

#include "block_motion.hpp"
#include "lanes/mask.hpp"
#include "laws/variation.hpp"

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
  const T all =
      ((left.distance_squared + left.speed_squared) + left.rate_squared) + left.joint_rates_squared;
  return mask<T>(laws::is_finite(all)) & mask<T>(left.distance_squared < bounds.distance_squared) &
         mask<T>(left.speed_squared < bounds.speed_squared) &
         mask<T>(left.rate_squared < bounds.rate_squared) &
         mask<T>(left.joint_rates_squared < bounds.rate_squared);
}

/// Add the joint rates after a step to the variation of the vehicles that have taken it.
/// \param rate  called as rate(i) for each rotor
template <class T, class Rate>
QUADCORE_LAW void add_rates(const Block& block, std::size_t first, const Mask<T>& flies,
                            const Rate& rate) {
  if (!block.variation) return;
  for (std::size_t i = 0; i < block.rotors; ++i) {
    double* const rows = block.variation + i * laws::VariationRow::count * widest_lanes + first;
    const T last = laws::load<T>(rows + laws::VariationRow::last * widest_lanes);
    laws::add_variation(rows, laws::chosen_by(flies, rate(i), last));
  }
}

/// Copy the numbers of the vehicles that fly, which in most steps are all.
template <class T>
QUADCORE_LAW void copy_flying(const double* from, double* to, std::size_t numbers,
                              const Mask<T>& flies) {
  if (__builtin_expect(laws::any(~flies), 0)) {
    for (std::size_t row = 0; row < numbers; row += widest_lanes) {
      laws::store(to + row,
                  laws::chosen_by(flies, laws::load<T>(from + row), laws::load<T>(to + row)));
    }
  } else {
    for (std::size_t row = 0; row < numbers; row += widest_lanes) {
      laws::store(to + row, laws::load<T>(from + row));
    }
  }
}

/// Return the vehicles that have further steps to take, and stay in their balls without obstacles
/// for a distance `ahead` [m]. The block has such balls.
template <class T>
QUADCORE_LAW Mask<T> stays_clear(const Block& block, std::size_t first, const Vec3<T>& p_W, T ahead,
                                 const Mask<T>& steps, std::int64_t count) {
  const Table<T> balls{block.clear + first};
  const Vec3<T> away_W = p_W - balls.vector(ClearRow::center_W);
  const T left = balls.number(ClearRow::radius) - ahead;
  return mask<T>(left > 0) & mask<T>(laws::dot(away_W, away_W) < left * left) &
         mask<T>(steps < count);
}

}  // namespace quadcore::batch
