#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "lanes/arc_tangent.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"

namespace {

double from_pattern(std::uint64_t pattern) {
  double number;
  std::memcpy(&number, &pattern, sizeof number);
  return number;
}

/// Coordinates of points in all directions, with special values.
struct Points {
  std::vector<double> x, y;

  Points() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double special[] = {0,      -0.0,   1,        -1,          0.4375, 0.6875,
                              1.1875, 2.4375, infinity, -infinity,   5e-324, 1e-300,
                              1e300,  1e18,   1e19,     std::nan("")};
    for (const double of_x : special) {
      for (const double of_y : special) add(of_x, of_y);
    }
    for (std::uint64_t i = 0; i < 40000; ++i) {
      const std::uint64_t a = quadcore::random_bits(1, i), b = quadcore::random_bits(2, i);
      add(from_pattern(a), from_pattern(b));  // of any size
      const auto near = [](std::uint64_t bits) { return std::ldexp(double(bits), -63) - 1; };
      add(near(a), near(b));
    }
  }
  void add(double of_x, double of_y) {
    x.push_back(of_x);
    y.push_back(of_y);
  }
};

bool are_equal(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

template <int W>
void compare_angles_with_single_ones(const Points& points) {
  using T = quadcore::laws::Pack<W>;
  std::size_t equal = 0;
  for (std::size_t i = 0; i + W <= points.x.size(); i += W) {
    double angles[W], sines[W];
    const T x = quadcore::laws::load<T>(&points.x[i]), y = quadcore::laws::load<T>(&points.y[i]);
    quadcore::laws::store(angles, quadcore::laws::arc_tangent(y, x));
    quadcore::laws::store(sines, quadcore::laws::arc_sine(x));
    for (int k = 0; k < W; ++k) {
      const double of_x = points.x[i + k], of_y = points.y[i + k];
      equal += are_equal(angles[k], quadcore::elementary::atan2(of_y, of_x)) &&
               are_equal(sines[k], quadcore::elementary::asin(of_x));
    }
  }
  CHECK(equal == points.x.size());
}

TEST_CASE("arc tangents and arc sines of packs are bit-identical to those of single numbers") {
  const Points points;
  REQUIRE(points.x.size() % 8 == 0);
  compare_angles_with_single_ones<1>(points);
  compare_angles_with_single_ones<2>(points);
  compare_angles_with_single_ones<4>(points);
  compare_angles_with_single_ones<8>(points);
}

}  // namespace
