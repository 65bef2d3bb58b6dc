#pragma once

#include "sine_cosine.hpp"
#include "vec3.hpp"

namespace quadcore::laws {

/// Return the equivalent angle in [-pi, pi]; exact if it is less than one turn outside.
template <class T>
QUADCORE_LAW T within_half_turn(T angle) {
  return angle - nearest<T>(angle * 0.15915494309189535).value * 6.283185307179586;
}

/// Return a vector rotated about a unit axis by the angle with this sine and cosine (Rodrigues).
template <class T>
QUADCORE_LAW Vec3<T> turned(const Vec3<T>& axis, const SineCosine<T>& angle, const Vec3<T>& a) {
  return angle.cos * a + angle.sin * cross(axis, a) + (dot(axis, a) * (1 - angle.cos)) * axis;
}

}  // namespace quadcore::laws
