#pragma once

/// \file
/// Elementary functions that give the same bytes on every machine. The C library's sin, cos, atan2,
/// log, exp and the like do not: glibc picks a variant by processor (with fused multiply-adds or
/// without), and versions of it differ, all in the last digit, which a vehicle that is unstable in
/// open loop soon makes visible. Whatever feeds a state is computed with these. What IEEE 754
/// rounds exactly (+ - * / and std::sqrt, std::floor, std::remainder ...) is the same everywhere.
///
/// Within 1 unit in the last place of the true value (atan2: 2, asin: 3), for every argument.

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {
/// Elementary functions that give the same bytes on every machine.
namespace elementary {

/// Sine and cosine of one angle.
struct SineCosine {
  /// Sine, in [-1, 1].
  double sin, cos;  ///< cosine, in [-1, 1]
};

/// Sine and cosine of an angle [rad] at once; NaN for an angle that is not finite.
SineCosine sincos(double x);
/// Sine of an angle [rad]; where both are wanted, sincos() takes half as long.
inline double sin(double x) { return sincos(x).sin; }
/// Cosine of an angle [rad]; where both are wanted, sincos() takes half as long.
inline double cos(double x) { return sincos(x).cos; }
/// Angle of the point (x, y) in [-pi, pi] [rad], zeros and infinities as in the C library.
double atan2(double y, double x);
/// In [-pi/2, pi/2] [rad]; NaN outside of [-1, 1].
double asin(double x);
/// Natural logarithm; -infinity at 0, NaN below.
double log(double x);
/// e to the power x; above about 709.78 infinity, below about -745.13 zero.
double exp(double x);

}  // namespace elementary
}  // namespace quadcore
