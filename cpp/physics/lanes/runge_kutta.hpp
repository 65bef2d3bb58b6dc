#pragma once

#include "vec3.hpp"

namespace quadcore {

/// Which of the four rates of a step: the first, the last, or between.
enum class Stage { first, between, last };

/// What becomes of the rate of a state, k: the sum of rates takes weight k, and the next state is
/// reach k from where the step began, or after the last stage reach times the sum.
struct Share {
  double weight, reach;
};

/// The numbers of a step of the classical fourth-order Runge-Kutta method, wherever they lie.
struct StageNumbers {
  const double* begin;  ///< the state in which the step begins
  double* stage;        ///< the state of the next stage
  double* sum;          ///< of the rates
  double* end;          ///< the state in which the step ends; may be `begin` or `stage`
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
