#include <doctest/doctest.h>

#include "lanes/pack.hpp"

namespace {

template <int W>
void read_and_write_everywhere() {
  alignas(64) double from[3 * W];
  alignas(64) double to[3 * W];
  for (int i = 0; i < 3 * W; ++i) from[i] = i;
  for (int begin = 0; begin < W; ++begin) {
    const int end = 2 * W - begin;
    quadcore::laws::store(to + end, quadcore::laws::load<quadcore::laws::Pack<W>>(from + begin));
    for (int i = 0; i < W; ++i) CHECK(to[end + i] == begin + i);
  }
}

TEST_CASE("packs are read and written wherever numbers lie") {
  read_and_write_everywhere<1>();
  read_and_write_everywhere<2>();
  read_and_write_everywhere<4>();
  read_and_write_everywhere<8>();
}

}  // namespace
