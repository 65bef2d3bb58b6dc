#pragma once

#include "lanes/sine_cosine.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore::laws {

/// Sines and cosines of angles [rad], bit-identical to elementary::sincos.
template <class T>
QUADCORE_LAW SineCosine<T> sine_and_cosine(T x) {
  const QuarterTurns<T> once = reduced_once(x);
  if (__builtin_expect(!any(loses_digits(x, once.y)), 1)) return sine_and_cosine_of(once);
  double numbers[lanes_of<T>], sines[lanes_of<T>], cosines[lanes_of<T>];
  store(numbers, x);
  for (int i = 0; i < lanes_of<T>; ++i) {
    const elementary::SineCosine one = elementary::sincos(numbers[i]);
    sines[i] = one.sin;
    cosines[i] = one.cos;
  }
  return {load<T>(sines), load<T>(cosines)};
}

}  // namespace quadcore::laws
