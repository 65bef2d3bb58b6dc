#pragma once

#include "vec3.hpp"

namespace quadcore {

/// Stage of a step: the first, the last, or between.
enum class Stage { first, between, last };

/// Use of a stage's rate k: the sum of rates increases by weight k, and the next state is the start
/// plus reach k, or after the last stage the start plus reach times the sum.
struct Share {
  double weight, reach;
};

/// Arrays of a step of the classical fourth-order Runge-Kutta method.
struct StageNumbers {
  const double* begin;  ///< state at the start of the step
  double* stage;        ///< state of the next stage
  double* sum;          ///< sum of the rates
  double* end;          ///< state at the end of the step; may be `begin` or `stage`
};

/// Return the next state of a number that was `begin` at the start of the step and now has the rate
/// k, which is added to the sum of the rates.
template <Stage stage, class T>
QUADCORE_LAW T share_out(const Share& share, T begin, T& sum, T k) {
  if constexpr (stage == Stage::first) sum = k;
  if constexpr (stage == Stage::between) sum = sum + share.weight * k;
  if constexpr (stage == Stage::last) sum = sum + k;
  return begin + share.reach * (stage == Stage::last ? sum : k);
}

/// Share out the rate of the numbers at a place.
template <Stage stage, class T>
QUADCORE_LAW void share_out(const StageNumbers& numbers, const Share& share, std::size_t place,
                            T k) {
  T sum{};
  if constexpr (stage != Stage::first) sum = laws::load<T>(numbers.sum + place);
  const T next = share_out<stage>(share, laws::load<T>(numbers.begin + place), sum, k);
  if constexpr (stage != Stage::last) laws::store(numbers.sum + place, sum);
  laws::store((stage == Stage::last ? numbers.end : numbers.stage) + place, next);
}

}  // namespace quadcore
