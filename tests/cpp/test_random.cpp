#include <doctest/doctest.h>

#include <bitset>
#include <cmath>

#include "quadcore/plugin/random.hpp"

using namespace quadcore;

TEST_CASE("the bits are SplitMix64's") {
  // From the reference implementation by Sebastiano Vigna, seeds 0 and 1234567.
  CHECK(random_bits(0, 0) == 0xE220A8397B1DCDAFULL);
  CHECK(random_bits(0, 1) == 0x6E789E6AA1B965F4ULL);
  CHECK(random_bits(0, 2) == 0x06C45D188009454FULL);
  CHECK(random_bits(1234567, 0) == 6457827717110365317ULL);
  CHECK(random_bits(1234567, 1) == 3203168211198807973ULL);
}

TEST_CASE("normal numbers have the moments of the normal distribution") {
  constexpr int n = 200000;
  double count = 0, sums[5] = {}, lagged = 0, before = 0;
  int beyond_two = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random_normal(42, count);
    for (int k = 1; k < 5; ++k) sums[k] += std::pow(x, k);
    lagged += x * before;
    before = x;
    beyond_two += std::abs(x) > 2;
  }
  CHECK(count == 2.0 * n);
  // Within five standard errors: the variance of x^k is that of the normal moments.
  CHECK(std::abs(sums[1] / n) < 5 * std::sqrt(1.0 / n));
  CHECK(std::abs(sums[2] / n - 1) < 5 * std::sqrt(2.0 / n));
  CHECK(std::abs(sums[3] / n) < 5 * std::sqrt(15.0 / n));
  CHECK(std::abs(sums[4] / n - 3) < 5 * std::sqrt(96.0 / n));
  CHECK(std::abs(lagged / n) < 5 * std::sqrt(1.0 / n));
  CHECK(std::abs(beyond_two / double(n) - 0.0455003) < 5 * std::sqrt(0.0455 / n));
}

TEST_CASE("a stream goes on where its count says") {
  double count = 0;
  for (int i = 0; i < 10; ++i) random_normal(3, count);
  double saved = count;
  const double next = random_normal(3, count);
  CHECK(random_normal(3, saved) == next);
}

TEST_CASE("streams of other names and seeds have nothing in common") {
  const std::uint64_t seeds[] = {stream_seed(1, "odometry"), stream_seed(1, "odometri"),
                                 stream_seed(2, "odometry"), stream_seed(1, "")};
  for (const std::uint64_t a : seeds) {
    for (const std::uint64_t b : seeds) {
      if (&a == &b || a == b) continue;
      // Half of the bits of each draw differ.
      std::size_t differing = 0;
      for (std::uint64_t i = 0; i < 100; ++i) {
        differing += std::bitset<64>(random_bits(a, i) ^ random_bits(b, i)).count();
      }
      CHECK(std::abs(double(differing) - 3200) < 5 * std::sqrt(1600.0));
    }
  }
  CHECK(seeds[0] != seeds[1]);
  CHECK(seeds[0] != seeds[2]);
}
