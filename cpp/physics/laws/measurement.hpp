#pragma once

#include "lanes/quaternion.hpp"
#include "lanes/whole_numbers.hpp"
#include "laws/angles.hpp"

/// \file
/// Errors of measurements for packs, bit-identical to those of quadcore/odometry_errors.hpp.

namespace quadcore::laws {

/// Return the multiple of a resolution that is nearest to a number.
template <class T>
QUADCORE_LAW T quantised(T number, T resolution) {
  return resolution * floor(number / resolution + 0.5);
}
template <class T>
QUADCORE_LAW Vec3<T> quantised(const Vec3<T>& a, T resolution) {
  return {quantised(a.x, resolution), quantised(a.y, resolution), quantised(a.z, resolution)};
}

/// Return an orientation after a rotation about its own axes; the direction of the vector is the
/// axis and its norm the angle.
template <class T>
QUADCORE_LAW Quaternion<T> turned_in_body(const Quaternion<T>& q, const Vec3<T>& turn) {
  const T angle = square_root(dot(turn, turn));
  const SineCosine<T> half = sine_and_cosine(angle / 2);
  const T x = half.sin * (turn.x / angle), y = half.sin * (turn.y / angle),
          z = half.sin * (turn.z / angle), w = half.cos;
  const auto turns = angle > 0;
  return {chosen_by(turns, (q.w * x + q.y * z) - (q.z * y - q.x * w), q.x),
          chosen_by(turns, (q.w * y + q.y * w) + (q.z * x - q.x * z), q.y),
          chosen_by(turns, (q.w * z - q.y * x) + (q.z * w + q.x * y), q.z),
          chosen_by(turns, (q.w * w - q.y * y) - (q.z * z + q.x * x), q.w)};
}

}  // namespace quadcore::laws
