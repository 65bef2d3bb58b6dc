#include <doctest/doctest.h>

#include <cmath>

#include "derivatives.hpp"
#include "quadcore/plugin/error.hpp"
#include "references/set_points.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

/// Somewhere on the way, nothing of it zero.
Reference on_the_way() {
  Reference from;
  from.position = {1, -2, 3};
  from.velocity = {0.3, 0.1, -0.2};
  from.acceleration = {0.5, -0.4, 0.3};
  from.jerk = {-0.2, 0.6, 0.1};
  from.yaw = 2.5;
  from.yaw_rate = 0.3;
  from.yaw_acceleration = -0.2;
  return from;
}

double distance(const Vector3d& a, const Vector3d& b) { return (a - b).norm(); }

}  // namespace

TEST_CASE("a drive goes by the heading, turns with it, and ends in a hover") {
  for (const double rate : {0.0, 1e-5, 0.9, -2.0}) {
    const auto shape = drive(on_the_way(), {{1.2, -0.5, 0.3}, rate}, 1.5);
    for (const double t : {0.2, 1.1}) test::check_derivatives(*shape, t);
    CHECK(distance(shape->at(0).position, {1, -2, 3}) == doctest::Approx(0));
    const double c = std::cos(2.5), s = std::sin(2.5);
    const Vector3d along(1.2 * c + 0.5 * s, 1.2 * s - 0.5 * c, 0.3);
    CHECK(distance(shape->at(0).velocity, along) < 1e-12);
    const Reference last = shape->at(1.5), later = shape->at(7);
    CHECK(distance(shape->at(1.5 - 1e-9).position, last.position) < 1e-8);
    CHECK(last.position == later.position);
    CHECK(later.velocity.isZero(0));
    CHECK(later.yaw == doctest::Approx(2.5 + 1.5 * rate));
  }
}

TEST_CASE("a path leads from what was flown through points, with what is given of them") {
  PathPoint first{1.5, {2, 0, 4}, -3, {}, {}};
  first.velocity = {{0.4, -0.6, 0.2}, 0.5};
  PathPoint second{3, {3, 1, 3}, -2.8, {}, {}};
  second.velocity = {{-0.1, 0.2, 0.3}, -0.4};
  second.acceleration = {{0.7, -0.5, 0.6}, 0.2};
  const PathPoint third{4, {2, 2, 2}, -2, {}, {}}, last{5, {0, 0, 3}, -1, {}, {}};
  const Reference from = on_the_way();
  const auto path = through(from, {first, second, third, last});

  const Reference start = path->at(0);
  CHECK(distance(start.position, from.position) < 1e-12);
  CHECK(distance(start.velocity, from.velocity) < 1e-12);
  CHECK(distance(start.acceleration, from.acceleration) < 1e-11);
  CHECK(distance(start.jerk, from.jerk) < 1e-10);
  CHECK(start.yaw_rate == doctest::Approx(0.3));
  for (const PathPoint& p : {first, second, third}) {
    const Reference before = path->at(p.t - 1e-9), there = path->at(p.t);
    CHECK(distance(there.position, p.position) < 1e-10);
    // By the short way: 2.5, then -3 and a whole turn.
    CHECK(there.yaw == doctest::Approx(p.yaw + 2 * M_PI));
    if (p.velocity) CHECK(distance(there.velocity, p.velocity->of_position) < 1e-10);
    if (p.velocity) CHECK(there.yaw_rate == doctest::Approx(p.velocity->of_yaw));
    if (p.acceleration) CHECK(distance(there.acceleration, p.acceleration->of_position) < 1e-9);
    CHECK(distance(before.jerk, there.jerk) < 1e-5);
    // What is given costs continuity of the seventh less as high a derivative, and none below.
    CHECK(distance(before.snap, there.snap) < 1e-4);
  }
  const Reference end = path->at(5);
  CHECK(distance(end.position, last.position) < 1e-12);
  CHECK(end.velocity.isZero(0));
  CHECK(distance(path->at(5 - 1e-9).velocity, Vector3d::Zero()) < 1e-7);
  for (const double t : {0.7, 2.2, 3.6, 4.4}) test::check_derivatives(*path, t);
}

TEST_CASE("given what is smoothest anyway, a path is the same") {
  PathPoint middle{1, {1, 2, 0}, 0.4, {}, {}};
  const PathPoint begin{0, {0, 0, 0}, 0, {}, {}}, end{3, {4, -1, 1}, 1, {}, {}};
  const auto path = through({}, {begin, middle, end});
  const Reference there = path->at(1);
  middle.velocity = {there.velocity, there.yaw_rate};
  middle.acceleration = {there.acceleration, there.yaw_acceleration};
  const auto again = through({}, {begin, middle, end});
  for (const double t : {0.3, 0.9, 1.8, 2.7}) {
    CHECK(distance(again->at(t).position, path->at(t).position) < 1e-10);
    CHECK(distance(again->at(t).snap, path->at(t).snap) < 1e-8);
  }
}

TEST_CASE("a lone point is held, with what is given of it") {
  PathPoint point{0, {1, 2, 3}, 0.5, {}, {}};
  point.velocity = {{0.1, 0, 0}, 0.2};
  const auto shape = through(on_the_way(), {point});
  for (const double t : {0.0, 5.0}) {
    CHECK(shape->at(t).position == point.position);
    CHECK(shape->at(t).velocity == Vector3d(0.1, 0, 0));
    CHECK(shape->at(t).yaw_rate == 0.2);
    CHECK(shape->at(t).acceleration.isZero(0));
  }
}

TEST_CASE("points that make no path are refused") {
  const PathPoint late{2, {1, 2, 3}, 0, {}, {}}, soon{1, {1, 2, 3}, 0, {}, {}},
      before{-1, {1, 2, 3}, 0, {}, {}};
  CHECK_THROWS_WITH_AS(through({}, {}), "the path has no points. Give at least one.", InputError);
  CHECK_THROWS_WITH_AS(through({}, {before}), "the path starts at a negative time. Start at 0.",
                       InputError);
  CHECK_THROWS_WITH_AS(
      through({}, {late, soon}),
      "point 2 of the path is not later than the one before. Sort the points by time.", InputError);
}
