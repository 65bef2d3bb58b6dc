#pragma once

#include "pack.hpp"

namespace quadcore::laws {

template <class T>
struct SineCosine {
  T sin, cos;
};

/// An angle as quadrant pi/2 + y + tail, up to whole turns, with |y| <= pi/4. The quadrant is in
/// the last two bits.
template <class T>
struct QuarterTurns {
  T y, tail;
  BitsOf<T> quadrant;
};

/// Maximum angle for which the number of quarter turns has at most 20 bits.
constexpr double largest_medium_angle = 1e6;

/// pi/2 in pieces of 33 bits, and the remainder of each (fdlibm 5.3, e_rem_pio2.c; the method is
/// that of W. J. Cody, W. Waite, "Software Manual for the Elementary Functions", 1980).
namespace half_pi {
constexpr double inverse = 6.36619772367581382433e-01;
constexpr double first = 1.57079632673412561417e+00, after_first = 6.07710050650619224932e-11;
constexpr double second = 6.07710050630396597660e-11, after_second = 2.02226624879595063154e-21;
constexpr double third = 2.02226624871116645580e-21, after_third = 8.47842766036889956997e-32;
}  // namespace half_pi

/// Return the nearest whole number, ties to even, of a number below 2^51. Its last bits are those
/// of the sum with 1.5 2^52.
template <class T>
struct Whole {
  T value;
  BitsOf<T> bits;
};
template <class T>
QUADCORE_LAW Whole<T> nearest(T a) {
  constexpr double to_whole = 6755399441055744.0;
  const T sum = a + to_whole;
  return {sum - to_whole, bits(sum)};
}

/// Sufficient for most angles, see loses_digits().
template <class T>
QUADCORE_LAW QuarterTurns<T> reduced_once(T x) {
  const Whole<T> n = nearest<T>(x * half_pi::inverse);
  const T rest = x - n.value * half_pi::first;
  const T tail = n.value * half_pi::after_first;
  const T y = rest - tail;
  return {y, (rest - y) - tail, n.bits};
}

/// Return whether an angle is so close to a quarter turn that its digits cancel after one
/// reduction, or too large for that reduction.
template <class T>
QUADCORE_LAW auto loses_digits(T x, T y) {
  const T size = absolute(x);
  return (absolute(y) < 1e-5 * size) | (size > largest_medium_angle);
}

/// Return sine and cosine of a reduced angle, by the minimax polynomials of fdlibm 5.3 (Sun
/// Microsystems, 1993, k_sin.c, k_cos.c at netlib.org/fdlibm, which derive them and bound their
/// errors).
template <class T>
QUADCORE_LAW SineCosine<T> sine_and_cosine_of(const QuarterTurns<T>& angle) {
  const T y = angle.y, tail = angle.tail;
  const T z = y * y;
  const T cube = z * y;
  const T r_sin = 8.33333333332248946124e-03 +
                  z * (-1.98412698298579493134e-04 +
                       z * (2.75573137070700676789e-06 +
                            z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  const T s = y - ((z * (0.5 * tail - cube * r_sin) - tail) + cube * 1.66666666666666324348e-01);
  const T r_cos =
      z * (4.16666666666666019037e-02 +
           z * (-1.38888888888741095749e-03 +
                z * (2.48015872894767294178e-05 +
                     z * (-2.75573143513906633035e-07 +
                          z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const T half = 0.5 * z;
  const T rest = 1 - half;
  const T c = rest + (((1 - rest) - half) + (z * r_cos - y * tail));
  // Odd quadrants swap the two; the sign follows from the quadrant's second bit.
  const BitsOf<T> odd = -(angle.quadrant & 1);
  const BitsOf<T> sine_sign = (angle.quadrant & 2) << 62;
  const BitsOf<T> cosine_sign = ((angle.quadrant + 1) & 2) << 62;
  return {from_bits<T>(((bits(s) & ~odd) | (bits(c) & odd)) ^ sine_sign),
          from_bits<T>(((bits(c) & ~odd) | (bits(s) & odd)) ^ cosine_sign)};
}

}  // namespace quadcore::laws
