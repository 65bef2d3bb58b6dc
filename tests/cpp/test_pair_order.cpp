#include <doctest/doctest.h>

#include "ode/pair_order.hpp"

using namespace quadcore;

namespace {

/// A cube with a side and a corner at the origin.
Bounds cube(double side, double x = 0, double y = 0, double z = 0) {
  return {x, x + side, y, y + side, z, z + side};
}

/// Return the obstacles that a vehicle finds, and whether each is the first of its pair. The
/// vehicle's index follows those of the obstacles.
std::vector<std::pair<std::size_t, bool>> find(PairOrder& pairs, const Bounds& vehicle,
                                               std::size_t obstacles) {
  std::vector<std::pair<std::size_t, bool>> found;
  for (const ModelPair& pair : pairs.find({{vehicle}})) {
    const bool obstacle_first = pair.second == obstacles;
    CHECK((obstacle_first ? pair.second : pair.first) == obstacles);
    found.emplace_back(obstacle_first ? pair.first : pair.second, obstacle_first);
  }
  return found;
}

using Order = std::vector<std::pair<std::size_t, bool>>;

}  // namespace

TEST_CASE("an obstacle in a level up to the vehicle's is the first of its pair, the oldest first") {
  PairOrder pairs({cube(0.9), cube(0.1), cube(0.95)});
  CHECK(find(pairs, cube(0.6), 3) == Order{{0, true}, {1, true}, {2, true}});
}

TEST_CASE("larger obstacles follow by level and cell, in a cell the newest first, planes at last") {
  const double inf = dInfinity;
  const Bounds plane = {-inf, inf, -inf, inf, -inf, 0.5};
  PairOrder pairs({plane, cube(300), cube(3), cube(3, 0.1), cube(3, 0, -2), cube(1.5, 0.2), plane});
  CHECK(find(pairs, cube(0.6, 0, -0.1), 7) ==
        Order{{5, false}, {4, false}, {3, false}, {2, false}, {0, false}, {1, false}, {6, false}});
}

TEST_CASE("models whose boxes do not touch are no pair") {
  PairOrder pairs({cube(1, 2), cube(1, 0, 0, 2), cube(1, 1)});
  CHECK(find(pairs, cube(1), 3) == Order{{2, true}});
}

TEST_CASE("of two models of a level, the newer one finds the other once they move") {
  PairOrder pairs({cube(0.9)});
  std::vector<std::array<std::size_t, 2>> found;
  for (const ModelPair& pair : pairs.find({{cube(0.8)}, {cube(0.7)}, {cube(0.6), 1}})) {
    found.push_back({pair.first, pair.second});
  }
  // Those that stand still are the first of the list, then those that have not moved for longest.
  CHECK(found ==
        std::vector<std::array<std::size_t, 2>>{{0, 1}, {0, 2}, {0, 3}, {3, 1}, {3, 2}, {2, 1}});
}

TEST_CASE("of two models of a level, the older one finds the other before they move") {
  PairOrder pairs({});
  std::vector<std::array<std::size_t, 2>> found;
  for (const ModelPair& pair : pairs.find({{cube(0.8), dInfinity}, {cube(0.7), dInfinity}})) {
    found.push_back({pair.first, pair.second});
  }
  CHECK(found == std::vector<std::array<std::size_t, 2>>{{0, 1}});
}
