#pragma once

#include "quadcore/elementary.hpp"
#include "sine_cosine.hpp"
#include "vec3.hpp"

namespace quadcore::laws {

/// Sines and cosines of angles [rad], those of elementary::sincos to the last digit.
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

/// The same angle within [-pi, pi], exactly as long as it is less than one turn beyond.
template <class T>
QUADCORE_LAW T within_half_turn(T angle) {
  return angle - nearest<T>(angle * 0.15915494309189535).value * 6.283185307179586;
}

/// A vector turned about a unit axis by the angle of which these are sine and cosine (Rodrigues).
template <class T>
QUADCORE_LAW Vec3<T> turned(const Vec3<T>& axis, const SineCosine<T>& angle, const Vec3<T>& a) {
  return angle.cos * a + angle.sin * cross(axis, a) + (dot(axis, a) * (1 - angle.cos)) * axis;
}

}  // namespace quadcore::laws
