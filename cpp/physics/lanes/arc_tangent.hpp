#pragma once

#include "pack.hpp"

namespace quadcore::laws {

/// Return the arc tangent of x >= 0, by the minimax polynomial of fdlibm 5.3 (Sun Microsystems,
/// 1993, s_atan.c at netlib.org/fdlibm, which derives it and bounds its error).
template <class T>
QUADCORE_LAW T arc_tangent_of_positive(T x) {
  T high{}, low{};
  if (any(x > 0.4375)) {
    // Reduced by atan(x) = atan(c) + atan((x - c)/(1 + c x)), c = 0.5, 1, 1.5, infinity.
    T top = x, bottom = broadcast<T>(1);
    const auto reduce = [&](double above, T a, T b, double c_high, double c_low) QUADCORE_INLINED {
      const auto is_above = x > above;
      top = chosen_by(is_above, a, top);
      bottom = chosen_by(is_above, b, bottom);
      high = chosen_by(is_above, broadcast<T>(c_high), high);
      low = chosen_by(is_above, broadcast<T>(c_low), low);
    };
    reduce(0.4375, 2 * x - 1, 2 + x, 4.63647609000806093515e-01, 2.26987774529616870924e-17);
    reduce(0.6875, x - 1, x + 1, 7.85398163397448278999e-01, 3.06161699786838301793e-17);
    reduce(1.1875, x - 1.5, 1 + 1.5 * x, 9.82793723247329054082e-01, 1.39033110312309984516e-17);
    reduce(2.4375, broadcast<T>(-1), x, 1.57079632679489655800e+00, 6.12323399573676603587e-17);
    x = top / bottom;
  }
  const T z = x * x;
  const T w = z * z;
  const T odd =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const T even =
      w * (-1.99999999998764832476e-01 +
           w * (-1.11111104054623557880e-01 +
                w * (-7.69187620504482999495e-02 +
                     w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  return high - ((x * (odd + even) - low) - x);
}

/// Return the angle of the point (x, y) in [-pi, pi] [rad], see elementary::atan2.
template <class T>
QUADCORE_LAW T arc_tangent(T y, T x) {
  constexpr double infinity = __builtin_huge_val(), nan = __builtin_nan("");
  constexpr double pi_high = 3.1415926535897931160e+00, pi_low = 1.2246467991473531772e-16;
  constexpr double two_to_60 = 1152921504606846976.0;
  const T ay = absolute(y), ax = absolute(x), quotient = ay / ax;
  const T finite = chosen_by((ay == infinity) & (ax == infinity), broadcast<T>(1), quotient);
  const T ratio = chosen_by(ay == 0, T{}, finite);
  const T angle = arc_tangent_of_positive(ratio);
  // Beyond the limit, the result is a quarter turn.
  const auto is_left = (bits(x) < 0) & (ratio < two_to_60);
  const T whole = chosen_by(is_left, pi_high - (angle - pi_low), angle);
  return chosen_by((x != x) | (y != y), broadcast<T>(nan), with_sign_of(y, whole));
}

/// Return the arc sine in [-pi/2, pi/2] [rad], see elementary::asin.
template <class T>
QUADCORE_LAW T arc_sine(T x) {
  const T angle = arc_tangent(x, square_root((1 - x) * (1 + x)));
  return chosen_by(absolute(x) <= 1, angle, broadcast<T>(__builtin_nan("")));
}

}  // namespace quadcore::laws
