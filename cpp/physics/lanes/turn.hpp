#pragma once

#include "sine_cosine.hpp"
#include "vec3.hpp"

namespace quadcore::laws {

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
