#pragma once

/// \file
/// Elementary functions with bit-identical results on every machine. The C library's sin, cos,
/// atan2, log, exp and similar functions differ in the last digit: glibc selects a variant by
/// processor (with or without fused multiply-adds), and its versions differ. A vehicle that is
/// unstable in open loop soon amplifies such differences. Everything that affects a state therefore
/// uses these functions. Operations that IEEE 754 rounds exactly (+ - * / and std::sqrt,
/// std::floor, std::remainder ...) are the same everywhere.
///
/// The error is at most 1 unit in the last place (atan2: 2, asin: 3) for every argument.

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {
/// Elementary functions with bit-identical results on every machine.
namespace elementary {

/// Sine and cosine of one angle.
struct SineCosine {
  /// Sine, in [-1, 1].
  double sin, cos;  ///< cosine, in [-1, 1]
};

/// Return sine and cosine of an angle [rad]; NaN for an angle that is not finite.
SineCosine sincos(double x);
/// Return the sine of an angle [rad]. Use sincos() if both are needed; it takes half the time.
inline double sin(double x) { return sincos(x).sin; }
/// Return the cosine of an angle [rad]. Use sincos() if both are needed; it takes half the time.
inline double cos(double x) { return sincos(x).cos; }
/// Return the angle of the point (x, y) in [-pi, pi] [rad]. Zeros and infinities behave as in the C
/// library.
double atan2(double y, double x);
/// Return the arc sine in [-pi/2, pi/2] [rad]; NaN outside [-1, 1].
double asin(double x);
/// Return the natural logarithm; -infinity at 0, NaN below.
double log(double x);
/// Return e to the power x; infinity above about 709.78, zero below about -745.13.
double exp(double x);

}  // namespace elementary
}  // namespace quadcore
