#include "quadcore/plugin/elementary.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "argument_reduction.hpp"
#include "lanes/arc_tangent.hpp"
#include "lanes/logarithm.hpp"
#include "lanes/sine_cosine.hpp"

// The minimax polynomials are those of fdlibm 5.3 (Sun Microsystems, 1993, e_exp.c at
// netlib.org/fdlibm), whose files derive them and bound their errors; splitting the argument in two
// follows W. J. Cody, W. Waite, "Software Manual for the Elementary Functions", 1980.
//
// No library replaces them: SLEEF 3.5 and correctly rounded functions differ in the last digit of
// 3 % (sine) to 18 % (atan2) of the values, which would change every recorded flight.

namespace quadcore::elementary {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using laws::ln2_high;
using laws::ln2_low;

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

double atan2(double y, double x) { return laws::arc_tangent(y, x); }

double asin(double x) { return laws::arc_sine(x); }

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
