#include "quadcore/plugin/elementary.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "argument_reduction.hpp"
#include "lanes/logarithm.hpp"
#include "lanes/sine_cosine.hpp"

// The minimax polynomials are those of fdlibm 5.3 (Sun Microsystems, 1993, s_atan.c,
// e_exp.c at netlib.org/fdlibm), whose files derive them and bound their errors; splitting the
// argument in two follows W. J. Cody, W. Waite, "Software Manual for the Elementary Functions",
// 1980.
//
// No library replaces them: SLEEF 3.5 and correctly rounded functions differ in the last digit of
// 3 % (sine) to 18 % (atan2) of the values, which would change every recorded flight.

namespace quadcore::elementary {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using laws::ln2_high;
using laws::ln2_low;

/// Return the arc tangent of x >= 0.
double atan_of_positive(double x) {
  // Reduced by atan(x) = atan(c) + atan((x - c)/(1 + c x)), c = 0.5, 1, 1.5, infinity.
  double high = 0, low = 0;
  if (x > 2.4375) {
    high = 1.57079632679489655800e+00;
    low = 6.12323399573676603587e-17;
    x = -1 / x;
  } else if (x > 1.1875) {
    high = 9.82793723247329054082e-01;
    low = 1.39033110312309984516e-17;
    x = (x - 1.5) / (1 + 1.5 * x);
  } else if (x > 0.6875) {
    high = 7.85398163397448278999e-01;
    low = 3.06161699786838301793e-17;
    x = (x - 1) / (x + 1);
  } else if (x > 0.4375) {
    high = 4.63647609000806093515e-01;
    low = 2.26987774529616870924e-17;
    x = (2 * x - 1) / (2 + x);
  }
  const double z = x * x;
  const double w = z * z;
  const double odd =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const double even =
      w * (-1.99999999998764832476e-01 +
           w * (-1.11111104054623557880e-01 +
                w * (-7.69187620504482999495e-02 +
                     w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  return high - ((x * (odd + even) - low) - x);
}

/// 2^k for -1022 <= k <= 1023.
double power_of_two(int k) {
  const std::uint64_t bits = static_cast<std::uint64_t>(k + 1023) << 52;
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return power;
}

}  // namespace

SineCosine sincos(double x) {
  const Reduced r = reduced(x);
  const auto result = laws::sine_and_cosine_of<double>({r.y, r.tail, r.quadrant});
  return {result.sin, result.cos};
}

double atan2(double y, double x) {
  constexpr double pi_high = 3.1415926535897931160e+00;
  constexpr double pi_low = 1.2246467991473531772e-16;
  constexpr double two_to_60 = 1152921504606846976.0;
  if (std::isnan(x) || std::isnan(y)) return nan;
  const double ay = std::abs(y), ax = std::abs(x);
  const double ratio = ay == 0 ? 0 : std::isinf(ay) && std::isinf(ax) ? 1 : ay / ax;
  const double angle = atan_of_positive(ratio);
  const bool left =
      std::signbit(x) && ratio < two_to_60;  // beyond it, the result is a quarter turn
  return std::copysign(left ? pi_high - (angle - pi_low) : angle, y);
}

double asin(double x) { return std::abs(x) <= 1 ? atan2(x, std::sqrt((1 - x) * (1 + x))) : nan; }

double log(double x) {
  if (!(x > 0)) return x == 0 ? -infinity : nan;
  if (std::isinf(x)) return x;
  double k = 0;
  if (x < std::numeric_limits<double>::min()) {  // subnormal
    x *= 18014398509481984.0;                    // 2^54
    k = -54;
  }
  return laws::logarithm(x, k);
}

double exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.782712893383973096) return infinity;
  if (x < -745.133219101941108420) return 0;
  // x = k ln 2 + high - low
  const double k = std::floor(x * 1.44269504088896338700 + 0.5);
  const double high = x - k * ln2_high, low = k * ln2_low;
  const double r = high - low;
  const double z = r * r;
  const double c =
      r - z * (1.66666666666666019037e-01 +
               z * (-2.77777777770155933842e-03 +
                    z * (6.61375632143793436117e-05 +
                         z * (-1.65339022054652515390e-06 + z * 4.13813679705723846039e-08))));
  const double y = 1 - ((low - r * c / (2 - c)) - high);
  const int half = static_cast<int>(k) / 2;  // applied in two halves near the ends of the range
  return y * power_of_two(half) * power_of_two(static_cast<int>(k) - half);
}

}  // namespace quadcore::elementary
