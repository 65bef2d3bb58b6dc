/// \file
/// The contact of two cylinders with parallel axes against closed forms.

#include <doctest/doctest.h>

#include "ode/cylinder_pair.hpp"
#include "ode/geoms.hpp"
#include "ode/ode_math.hpp"

using namespace quadcore;

namespace {

const Quaterniond q_WP(Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()));

/// Return a cylinder whose axis is the z axis of a turned frame P, at a position in that frame.
Geom create_cylinder(double radius, double length, const Vector3d& p_P) {
  Obstacle obstacle;
  obstacle.kind = ShapeKind::cylinder;
  obstacle.size = Vector3d(radius, length, 0);
  obstacle.position_W = q_WP * p_P;
  obstacle.orientation_W = q_WP;
  return create_solid(obstacle);
}

const Geom post = create_cylinder(0.3, 0.4, Vector3d::Zero());

}  // namespace

TEST_CASE("a cylinder on the end of a wider one is as deep in it as their ends overlap") {
  const Geom small = create_cylinder(0.1, 0.2, Vector3d(0.05, -0.02, 0.29));
  dContactGeom point;
  REQUIRE(collide_cylinders(small.get(), post.get(), point) == 1);
  CHECK(point.depth == doctest::Approx(0.01).epsilon(1e-5));
  CHECK((vec(point.normal) - q_WP * Vector3d::UnitZ()).norm() < 1e-5);
  const Vector3d p_P = q_WP.inverse() * vec(point.pos);
  CHECK((p_P.z() > 0.19 && p_P.z() < 0.2));  // between the ends
  CHECK((p_P - Vector3d(0.05, -0.02, p_P.z())).norm() < 0.1);
}

TEST_CASE("cylinders side by side touch along the line between their axes") {
  const Vector3d away(0.24, 0.32, 0.05);  // 0.4 m across
  const Geom beside = create_cylinder(0.13, 0.2, away);
  dContactGeom point;
  REQUIRE(collide_cylinders(beside.get(), post.get(), point) == 1);
  CHECK(point.depth == doctest::Approx(0.03).epsilon(1e-4));
  CHECK((vec(point.normal) - q_WP * Vector3d(0.6, 0.8, 0)).norm() < 5e-3);  // for 1e-6 m of depth
}

TEST_CASE("cylinders apart do not touch") {
  dContactGeom point;
  const Geom above = create_cylinder(0.1, 0.2, Vector3d(0.05, 0, 0.301));
  CHECK(collide_cylinders(above.get(), post.get(), point) == 0);
  const Geom beside = create_cylinder(0.1, 0.2, Vector3d(0.401, 0, 0.05));
  CHECK(collide_cylinders(beside.get(), post.get(), point) == 0);
}
