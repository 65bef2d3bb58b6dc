#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "plugin_bench.hpp"
#include "quadcore/ray.hpp"

/// \file
/// Rays against closed forms, and against the distance of points from the same shapes.

namespace quadcore::test {
namespace {

Obstacle shape_of(ShapeKind kind, const Vector3d& size, const Vector3d& position_W = {0, 0, 0}) {
  Obstacle obstacle;
  obstacle.kind = kind;
  obstacle.size = size;
  obstacle.position_W = position_W;
  return obstacle;
}

/// The twelve triangles of a box.
Obstacle box_of_triangles(const Vector3d& size) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    mesh->vertices.push_back((signs.cwiseProduct(size) / 2).cast<float>());
  }
  const unsigned faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh->triangles.push_back({f[0], f[1], f[2]});
    mesh->triangles.push_back({f[0], f[2], f[3]});
  }
  Obstacle obstacle = shape_of(ShapeKind::mesh, size);
  obstacle.mesh = mesh;
  return obstacle;
}

Ray along_x(double y, double z, double x = -5) { return {{x, y, z}, {1, 0, 0}}; }

}  // namespace

TEST_CASE("a ray meets each shape at the distance that geometry gives") {
  const Obstacle sphere = shape_of(ShapeKind::sphere, {2, 0, 0});
  CHECK(distance_along(along_x(0, 0), sphere) == doctest::Approx(3));
  CHECK(distance_along(along_x(1.2, 0), sphere) == doctest::Approx(5 - 1.6));
  CHECK(distance_along(along_x(2.1, 0), sphere) == INFINITY);
  CHECK(distance_along(along_x(0, 0, 0.5), sphere) == doctest::Approx(1.5));  // from inside
  CHECK(distance_along(along_x(0, 0, 3), sphere) == INFINITY);                // it is behind

  const Obstacle cylinder = shape_of(ShapeKind::cylinder, {1, 3, 0});
  CHECK(distance_along(along_x(0.6, 1.4), cylinder) == doctest::Approx(5 - 0.8));
  CHECK(distance_along(along_x(0.6, 1.6), cylinder) == INFINITY);
  CHECK(distance_along({{0.3, 0.2, 7}, {0, 0, -1}}, cylinder) == doctest::Approx(5.5));
  CHECK(distance_along({{0.8, 0.8, 7}, {0, 0, -1}}, cylinder) == INFINITY);

  Obstacle box = shape_of(ShapeKind::box, {1, 2, 4}, {0, 0, 1});
  CHECK(distance_along(along_x(0.9, 2.9), box) == doctest::Approx(4.5));
  CHECK(distance_along(along_x(1.1, 0), box) == INFINITY);
  box.orientation_W = Quaterniond(Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitZ()));
  CHECK(distance_along(along_x(0, 1), box) == doctest::Approx(5 - std::sqrt(0.5)));

  const Obstacle plane = shape_of(ShapeKind::plane, {0, 0, 2}, {7, 8, 1});
  const Vector3d down = Vector3d(0.6, 0, -0.8);
  CHECK(distance_along({{3, 3, 5}, down}, plane) == doctest::Approx(4.5 / 0.8));
  CHECK(distance_along({{3, 3, 5}, -down}, plane) == INFINITY);
  CHECK(distance_along({{3, 3, 5}, {1, 0, 0}}, plane) == INFINITY);
  CHECK(distance_along({{3, 3, 0.5}, down}, plane) == 0);
  CHECK(distance_along({{3, 3, 0.5}, -down}, plane) == INFINITY);  // it leaves the surface
}

TEST_CASE("a ray ends on the surface and does not cross it before") {
  Draw draw{5};
  const Obstacle shapes[] = {
      shape_of(ShapeKind::sphere, {0.7, 0, 0}), shape_of(ShapeKind::cylinder, {0.5, 1.3, 0}),
      shape_of(ShapeKind::box, {0.6, 1.1, 1.7}), shape_of(ShapeKind::plane, {0.3, -0.5, 0.8})};
  int hits = 0;
  for (Obstacle obstacle : shapes) {
    for (int i = 0; i < 300; ++i) {
      obstacle.position_W = draw.vector();
      obstacle.orientation_W = draw.rotation();
      const Ray ray{2 * draw.vector(), draw.direction()};
      const double distance = distance_along(ray, obstacle);
      const auto off = [&](double at) {
        return distance_to(obstacle, ray.origin_W + at * ray.direction_W);
      };
      const double reach = std::min(distance, 20.0);
      for (int part = 1; part < 100; ++part) {
        CHECK(off(0) * off(reach * part / 100) > 0);
      }
      if (distance == INFINITY) continue;
      ++hits;
      CHECK(std::abs(off(distance)) < 1e-12);
    }
  }
  CHECK(hits > 100);
}

TEST_CASE("a mesh is met as the shape that it fills") {
  Draw draw{6};
  const Vector3d size(0.5, 1, 2);  // exact as float
  const Obstacle box = shape_of(ShapeKind::box, size);
  const Obstacle mesh = box_of_triangles(size);
  for (int i = 0; i < 500; ++i) {
    const Ray ray{draw.vector(), draw.direction()};
    const double expected = distance_along(ray, box);
    if (expected == INFINITY) {
      CHECK(distance_along(ray, mesh) == INFINITY);
    } else {
      CHECK(distance_along(ray, mesh) == doctest::Approx(expected).epsilon(1e-12));
    }
  }
}

TEST_CASE("the range is that of the nearest thing within the maximum") {
  World world;
  world.obstacles = {shape_of(ShapeKind::sphere, {1, 0, 0}, {9, 0, 2}),
                     shape_of(ShapeKind::box, {1, 1, 1}, {5, 0, 2}),
                     shape_of(ShapeKind::cylinder, {1, 1, 0}, {-4, 0, 2}),
                     shape_of(ShapeKind::sphere, {1, 0, 0}, {3, 5, 2})};
  const Ray ahead{{0, 0, 2}, {1, 0, 0}}, down{{0, 0, 2}, {0, 0, -1}};
  CHECK(range_along(ahead, world, 10) == doctest::Approx(4.5));
  CHECK(range_along(ahead, world, 4.4) == INFINITY);
  CHECK(range_along(down, world, 10) == INFINITY);
  world.ground_plane = true;
  CHECK(range_along(down, world, 10) == doctest::Approx(2));
  CHECK(range_along({{0, 0, 2}, {0, 0, 1}}, world, 10) == INFINITY);
}

}  // namespace quadcore::test
