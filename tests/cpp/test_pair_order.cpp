#include <doctest/doctest.h>

#include "ode/pair_order.hpp"

using namespace quadcore;

namespace {

/// A cube with a side and a corner at the origin.
Bounds cube(double side, double x = 0, double y = 0, double z = 0) {
  return {x, x + side, y, y + side, z, z + side};
}

std::vector<std::size_t> order(const std::vector<ModelPair>& pairs) {
  std::vector<std::size_t> obstacles;
  for (const ModelPair& pair : pairs) obstacles.push_back(pair.obstacle);
  return obstacles;
}

}  // namespace

TEST_CASE("an obstacle in a level up to the vehicle's is the first of its pair, the oldest first") {
  PairOrder pairs({cube(0.9), cube(0.1), cube(0.95)});
  const std::vector<ModelPair>& found = pairs.find(cube(0.6));
  CHECK(order(found) == std::vector<std::size_t>{0, 1, 2});
  for (const ModelPair& pair : found) CHECK(pair.obstacle_first);
}

TEST_CASE("larger obstacles follow by level and cell, in a cell the newest first, planes at last") {
  const double inf = dInfinity;
  const Bounds plane = {-inf, inf, -inf, inf, -inf, 0.5};
  PairOrder pairs({plane, cube(300), cube(3), cube(3, 0.1), cube(3, 0, -2), cube(1.5, 0.2), plane});
  const std::vector<ModelPair>& found = pairs.find(cube(0.6, 0, -0.1));
  CHECK(order(found) == std::vector<std::size_t>{5, 4, 3, 2, 0, 1, 6});
  for (const ModelPair& pair : found) CHECK_FALSE(pair.obstacle_first);
}

TEST_CASE("models whose boxes do not touch are no pair") {
  PairOrder pairs({cube(1, 2), cube(1, 0, 0, 2), cube(1, 1)});
  CHECK(order(pairs.find(cube(1))) == std::vector<std::size_t>{2});
}
