#pragma once

#include "lanes/arc_tangent.hpp"
#include "lanes/sine_cosine.hpp"
#include "lanes/vec3.hpp"
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

/// Return the arc sine [rad] of the nearest number in [-1, 1], for sines with rounding errors.
template <class T>
QUADCORE_LAW T nearest_arc_sine(T sine) {
  return arc_sine(chosen_by(absolute(sine) > 1, with_sign_of(sine, broadcast<T>(1)), sine));
}

/// Sines and cosines of the roll and yaw of a rotation, times positive factors.
template <class T>
struct RollAndYaw {
  SineCosine<T> roll, yaw;
};
template <class T>
QUADCORE_LAW RollAndYaw<T> roll_and_yaw(const Matrix3<T>& R) {
  // At a pitch of +-90 degrees, roll and yaw rotate about the same axis; yaw takes the whole
  // rotation.
  const auto is_vertical = absolute(R.zx) > 1 - 1e-12;
  const auto chosen = [&](T at_vertical, T otherwise) QUADCORE_INLINED {
    return chosen_by(is_vertical, at_vertical, otherwise);
  };
  return {{chosen(T{}, R.zy), chosen(broadcast<T>(1), R.zz)},
          {chosen(-R.xy, R.yx), chosen(R.yy, R.xx)}};
}

/// Return roll, pitch and yaw [rad] of a rotation, see rpy_from_quaternion().
template <class T>
QUADCORE_LAW Vec3<T> roll_pitch_yaw(const Matrix3<T>& R) {
  const auto [roll, yaw] = roll_and_yaw(R);
  return {arc_tangent(roll.sin, roll.cos), nearest_arc_sine(-R.zx), arc_tangent(yaw.sin, yaw.cos)};
}

}  // namespace quadcore::laws
