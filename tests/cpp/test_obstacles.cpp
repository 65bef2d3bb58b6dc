#include <doctest/doctest.h>

#include <cmath>

#include "clear_ball.hpp"
#include "quadcore/plugin/obstacle.hpp"
#include "quadcore/plugin/random.hpp"

using namespace quadcore;

namespace {

Obstacle obstacle(ShapeKind kind, const Vector3d& size, const Vector3d& position,
                  const Vector3d& rpy = {0, 0, 0}) {
  Obstacle o;
  o.kind = kind;
  o.size = size;
  o.position_W = position;
  o.orientation_W = quaternion_from_rpy(rpy);
  return o;
}

}  // namespace

TEST_CASE("the distance of a point from an obstacle is that from its nearest surface") {
  const double quarter = std::acos(0.0);
  const Obstacle box = obstacle(ShapeKind::box, {2, 4, 6}, {10, 0, 0}, {0, 0, quarter});
  CHECK(distance_to(box, {10, 1.5, 0}) == doctest::Approx(0.5));
  CHECK(distance_to(box, {15, 5, 0}) == doctest::Approx(5));
  CHECK(distance_to(box, {10, 0.7, 0}) == doctest::Approx(-0.3));
  const Obstacle can = obstacle(ShapeKind::cylinder, {1, 4, 0}, {0, 0, 5}, {quarter, 0, 0});
  CHECK(distance_to(can, {0, 0, 7}) == doctest::Approx(1));
  CHECK(distance_to(can, {0, 5, 10}) == doctest::Approx(5));
  CHECK(distance_to(can, {0, 0, 5.4}) == doctest::Approx(-0.6));
  const Obstacle ball = obstacle(ShapeKind::sphere, {0.5, 0, 0}, {1, 2, 3});
  CHECK(distance_to(ball, {1, 2, 5}) == doctest::Approx(1.5));
  // Of a plane only the normal and z count: 2 x = 1.
  const Obstacle wall = obstacle(ShapeKind::plane, {2, 0, 0}, {7, 8, 1}, {1, 2, 3});
  CHECK(distance_to(wall, {3, -5, 9}) == doctest::Approx(2.5));
}

TEST_CASE("a clear ball answers as the nearest obstacle does, whatever was asked before") {
  std::vector<Obstacle> obstacles;
  double count = 0;
  for (int i = 0; i < 30; ++i) {
    Vector3d p, size;
    for (int k = 0; k < 3; ++k) {
      p[k] = 5 * random_normal(1, count);
      size[k] = 0.1 + std::abs(random_normal(1, count));
    }
    obstacles.push_back(obstacle(static_cast<ShapeKind>(i % 3), size, p, p));
  }
  ClearBall ball(obstacles);
  Vector3d p = {0, 0, 0};
  for (int i = 0; i < 2000; ++i) {
    for (int k = 0; k < 3; ++k) p[k] += 0.1 * random_normal(2, count);
    double nearest = INFINITY;
    for (const Obstacle& o : obstacles) nearest = std::min(nearest, distance_to(o, p));
    CHECK(ball.nearest(p) == nearest);
    const double radius = 0.1 + std::abs(random_normal(2, count));
    CHECK(ball.is_free(p, radius) == (radius < nearest));
  }
  CHECK(ClearBall({}).is_free(p, 1e300));
}
