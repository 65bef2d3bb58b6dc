#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lanes/mask.hpp"
#include "laws/motor_target.hpp"
#include "laws/variation.hpp"

namespace {

namespace laws = quadcore::laws;
using quadcore::widest_lanes;

/// Call test(width) with each width as a constant.
template <class Test>
void for_each_width(const Test& test) {
  test(std::integral_constant<int, 1>());
  test(std::integral_constant<int, 2>());
  test(std::integral_constant<int, 4>());
  test(std::integral_constant<int, 8>());
}

TEST_CASE("packs are read and written wherever numbers lie") {
  for_each_width([](auto width) {
    constexpr int W = width;
    alignas(64) double from[3 * W];
    alignas(64) double to[3 * W];
    for (int i = 0; i < 3 * W; ++i) from[i] = i;
    for (int begin = 0; begin < W; ++begin) {
      const int end = 2 * W - begin;
      laws::store(to + end, laws::load<laws::Pack<W>>(from + begin));
      for (int i = 0; i < W; ++i) CHECK(to[end + i] == begin + i);
    }
  });
}

TEST_CASE("a pack of one number keeps its sign and bits") {
  for_each_width([](auto width) {
    for (const double number : {-0.0, 0.1, -std::numeric_limits<double>::infinity()}) {
      double numbers[width];
      laws::store(numbers, laws::broadcast<laws::Pack<width>>(number));
      for (const double stored : numbers) {
        CHECK(stored == number);
        CHECK(std::signbit(stored) == std::signbit(number));
      }
    }
  });
}

TEST_CASE("a number that is not finite is found in every lane") {
  for_each_width([](auto width) {
    using T = laws::Pack<width>;
    double numbers[width] = {};
    const auto are_not_finite = [&] {
      return ~laws::mask<T>(laws::is_finite(laws::load<T>(numbers)));
    };
    CHECK_FALSE(laws::any(are_not_finite()));
    for (double& number : numbers) {
      for (const double wrong : {std::nan(""), -std::numeric_limits<double>::infinity()}) {
        number = wrong;
        std::int64_t found[width];
        laws::store_bits<T>(found, are_not_finite());
        CHECK(laws::any(are_not_finite()));
        for (int i = 0; i < width; ++i) CHECK(found[i] == -std::int64_t{&numbers[i] == &number});
      }
      number = 0;
    }
  });
}

TEST_CASE("targets of motors stay within the maximum speed") {
  for_each_width([](auto width) {
    using T = laws::Pack<width>;
    for (const double command : {-900.0, -800.0, -0.0, 300.0, 1e9}) {
      double targets[width];
      laws::store(targets, laws::motor_target(laws::broadcast<T>(command), laws::broadcast<T>(800),
                                              laws::broadcast<T>(10)));
      for (const double target : targets) CHECK(target == std::clamp(command, -800.0, 800.0) / 10);
    }
  });
}

TEST_CASE("the variation of a number is the sum of the changes of its magnitude") {
  for_each_width([](auto width) {
    using T = laws::Pack<width>;
    double rows[laws::VariationRow::count * widest_lanes] = {};
    laws::begin_variation(rows, laws::broadcast<T>(-3));
    for (const double number : {3.0, 5.0, -1.0})
      laws::add_variation(rows, laws::broadcast<T>(number));
    for (int i = 0; i < width; ++i) {
      CHECK(rows[laws::VariationRow::sum * widest_lanes + static_cast<std::size_t>(i)] == 6);
    }
  });
}

}  // namespace
