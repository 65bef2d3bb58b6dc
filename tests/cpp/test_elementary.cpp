#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"

using namespace quadcore;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Distance to the true value in units of the last place of a double.
double error(double found, long double exact) {
  const double rounded = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(rounded, infinity) - rounded;
  return static_cast<double>(std::abs((found - exact) / unit));
}

double uniform(std::uint64_t seed, std::uint64_t count) {
  return static_cast<double>(random_bits(seed, count) >> 11) / 9007199254740992.0;
}

/// Any finite double, small, large and subnormal alike.
double any_double(std::uint64_t count) {
  for (std::uint64_t seed = 1;; ++seed) {
    const std::uint64_t bits = random_bits(seed, count);
    double x;
    std::memcpy(&x, &bits, sizeof x);
    if (std::isfinite(x)) return x;
  }
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// The largest error of `function` over angles of every size, many of them beside whole numbers of
/// quarter turns, where digits cancel.
template <class Function, class Exact>
double worst_of_angles(const Function& function, const Exact& exact) {
  double worst = 0;
  const auto look = [&](double x) { worst = std::max(worst, error(function(x), exact(x))); };
  for (std::uint64_t i = 0; i < 200000; ++i) {
    look(8 * uniform(1, i) - 4);
    look(2e6 * uniform(2, i) - 1e6);
    look(std::ldexp(uniform(3, i) - 0.5, static_cast<int>(i % 200) - 100));
    look(any_double(i));
    const double quarters = std::floor(std::exp(40 * uniform(4, i))) * M_PI_2;
    look(quarters);
    look(-std::nextafter(quarters, 0));
  }
  for (const double x : {1e22, 6381956970095103.0 * std::ldexp(1, 797), 5e-324, 1e6, 1000000.5}) {
    look(x);
    look(-x);
  }
  return worst;
}

}  // namespace

TEST_CASE("sine and cosine are within one unit in the last place for every angle") {
  CHECK(worst_of_angles(elementary::sin, [](double x) { return sinl(x); }) < 1);
  CHECK(worst_of_angles(elementary::cos, [](double x) { return cosl(x); }) < 1);
  CHECK(same_bits(elementary::sin(-0.0), -0.0));
  CHECK(elementary::cos(0) == 1);
  for (const double x : {infinity, -infinity, no_number}) {
    CHECK(std::isnan(elementary::sin(x)));
    CHECK(std::isnan(elementary::cos(x)));
  }
}

TEST_CASE("the arc tangent of a point and the arc sine are within two and three units") {
  double worst_atan2 = 0, worst_asin = 0;
  for (std::uint64_t i = 0; i < 300000; ++i) {
    const double x = i % 2 ? any_double(2 * i) : uniform(5, i) - 0.5;
    const double y = i % 3 ? any_double(2 * i + 1) : uniform(6, i) - 0.5;
    const long double exact = atan2l(y, x);
    if (std::abs(exact) > std::numeric_limits<double>::min()) {
      worst_atan2 = std::max(worst_atan2, error(elementary::atan2(y, x), exact));
    }
    const double s = i % 2 ? 2 * uniform(7, i) - 1 : 1 - std::ldexp(uniform(7, i), -int(i % 60));
    worst_asin = std::max(worst_asin, error(elementary::asin(s), asinl(s)));
  }
  CHECK(worst_atan2 < 2);
  CHECK(worst_asin < 3);
  for (const double y : {0.0, -0.0, 1.0, -1.0, infinity, -infinity, no_number}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, infinity, -infinity, no_number}) {
      CAPTURE(y);
      CAPTURE(x);
      if (std::isnan(x) || std::isnan(y)) {
        CHECK(std::isnan(elementary::atan2(y, x)));
      } else {
        CHECK(same_bits(elementary::atan2(y, x), static_cast<double>(atan2l(y, x))));
      }
    }
  }
  CHECK(elementary::asin(1) == M_PI_2);
  CHECK(same_bits(elementary::asin(-0.0), -0.0));
  for (const double x : {1.0000001, -2.0, infinity, no_number})
    CHECK(std::isnan(elementary::asin(x)));
}

TEST_CASE("logarithm and exponential are within one unit in the last place") {
  double worst_log = 0, worst_exp = 0;
  for (std::uint64_t i = 0; i < 300000; ++i) {
    const double x =
        i % 2 ? std::abs(any_double(i)) : 1 + std::ldexp(uniform(8, i) - 0.5, -int(i % 50));
    worst_log = std::max(worst_log, error(elementary::log(x), logl(x)));
    const double y =
        i % 2 ? 1416 * uniform(9, i) - 708 : std::ldexp(uniform(9, i) - 0.5, -int(i % 60));
    worst_exp = std::max(worst_exp, error(elementary::exp(y), expl(y)));
  }
  CHECK(worst_log < 1);
  CHECK(worst_exp < 1);
  CHECK(elementary::log(5e-324) == doctest::Approx(-744.44007192138));
  CHECK(elementary::log(0) == -infinity);
  CHECK(elementary::log(infinity) == infinity);
  CHECK(std::isnan(elementary::log(-1)));
  CHECK(std::isnan(elementary::log(no_number)));
  CHECK(elementary::exp(0) == 1);
  CHECK(elementary::exp(710) == infinity);
  CHECK(elementary::exp(-745) == 5e-324);
  CHECK(elementary::exp(-746) == 0);
  CHECK(elementary::exp(-infinity) == 0);
  CHECK(std::isnan(elementary::exp(no_number)));
}
