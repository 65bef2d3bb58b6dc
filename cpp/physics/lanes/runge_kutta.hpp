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

/// Shares out the rate of the numbers at a place.
template <Stage stage, class T>
QUADCORE_LAW void share_out(const StageNumbers& numbers, const Share& share, std::size_t place,
                            T k) {
  T sum = k;
  if constexpr (stage == Stage::between)
    sum = laws::load<T>(numbers.sum + place) + share.weight * k;
  if constexpr (stage == Stage::last) sum = laws::load<T>(numbers.sum + place) + k;
  const T begin = laws::load<T>(numbers.begin + place);
  if constexpr (stage == Stage::last) {
    laws::store(numbers.end + place, begin + share.reach * sum);
  } else {
    laws::store(numbers.sum + place, sum);
    laws::store(numbers.stage + place, begin + share.reach * k);
  }
}

}  // namespace quadcore
