#include <doctest/doctest.h>

#include <random>

#include "quadcore/clearance.hpp"

using namespace quadcore;

namespace {

Model vehicle_of(const Collision& shape) {
  Model model;
  model.links.resize(1);
  model.links[0].collisions = {shape};
  return model;
}

Collision collision_of(ShapeKind kind, const Vector3d& size, const Vector3d& at = {0, 0, 0}) {
  Collision shape{kind, size, {}, ""};
  shape.pose.xyz = at;
  return shape;
}

World world_of(ShapeKind kind, const Vector3d& size, const Vector3d& position,
               const Quaterniond& orientation = Quaterniond::Identity()) {
  World world;
  Obstacle obstacle;
  obstacle.kind = kind, obstacle.size = size;
  obstacle.position_W = position, obstacle.orientation_W = orientation;
  world.obstacles = {obstacle};
  return world;
}

double distance(const Model& model, const World& world, const Vector3d& p = {0, 0, 0},
                const Quaterniond& q = Quaterniond::Identity()) {
  return Clearance(model, world).find(p, q).distance;
}

}  // namespace

TEST_CASE("distances of simple shapes are known") {
  const Model ball = vehicle_of(collision_of(ShapeKind::sphere, {0.5, 0, 0}));
  const Model box = vehicle_of(collision_of(ShapeKind::box, {1, 2, 3}));
  const Model disc = vehicle_of(collision_of(ShapeKind::cylinder, {1, 0.2, 0}));
  const World pole = world_of(ShapeKind::cylinder, {0.1, 12, 0}, {3, 0, 0});
  const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-6); };
  CHECK(distance(ball, pole) == near(2.4));
  CHECK(distance(box, pole) == near(2.4));
  CHECK(distance(disc, pole) == near(1.9));
  CHECK(distance(ball, pole, {3, 0, 7}) == near(0.5));  // above the pole
  CHECK(distance(ball, world_of(ShapeKind::sphere, {1, 0, 0}, {0, 3, 4})) == near(3.5));

  // Corner against corner, and edge against crossed edge.
  CHECK(distance(box, world_of(ShapeKind::box, {1, 1, 1}, {2, 3, 4})) ==
        near(Vector3d(1, 1.5, 2).norm()));
  const Quaterniond eighth = quaternion_about(Vector3d::UnitX(), 0.7853981633974483);
  CHECK(distance(box, world_of(ShapeKind::box, {1, 1, 1}, {0, 0, 5}, eighth)) ==
        near(5 - 1.5 - std::sqrt(0.5)));

  // n . x = z / |n|, whatever x and y of the pose.
  const World wall = world_of(ShapeKind::plane, {2, 0, 0}, {9, 9, -4});
  CHECK(distance(ball, wall) == near(1.5));
  CHECK(distance(box, wall, {0, 0, 0}, quaternion_about(Vector3d::UnitZ(), 1.5707963267948966)) ==
        near(1));
}

TEST_CASE("shapes that overlap touch") {
  const Model box = vehicle_of(collision_of(ShapeKind::box, {1, 1, 1}));
  CHECK(distance(box, world_of(ShapeKind::sphere, {1, 0, 0}, {1, 0, 0})) < 1e-6);
  CHECK(distance(box, world_of(ShapeKind::cylinder, {0.1, 9, 0}, {0.55, 0.3, 0})) < 1e-6);
  CHECK(distance(box, world_of(ShapeKind::plane, {0, 0, 1}, {0, 0, 0.2})) == 0);
}

TEST_CASE("a shape on a rotor counts as what it sweeps, and the nearest obstacle is named") {
  Model model = vehicle_of(collision_of(ShapeKind::sphere, {0.1, 0, 0}));
  model.links.resize(2);
  model.joints.resize(1);
  model.joints[0].pose.xyz = {1, 0, 0};
  model.joints[0].axis = Vector3d::UnitZ();
  model.links[1].collisions = {collision_of(ShapeKind::box, {0.4, 0.02, 0.01})};  // a blade
  World world = world_of(ShapeKind::sphere, {0.5, 0, 0}, {-9, 0, 0});
  const double reach = std::hypot(0.2, 0.01);
  world.obstacles.push_back(world_of(ShapeKind::cylinder, {0.1, 4, 0}, {1, 2, 0}).obstacles[0]);
  const Clearance::Nearest nearest =
      Clearance(model, world).find({0, 0, 0}, Quaterniond::Identity());
  CHECK(nearest.distance == doctest::Approx(1.9 - reach));
  CHECK(nearest.obstacle == 1);
  CHECK(std::isinf(distance(model, World())));
}

TEST_CASE("the distance of random shapes agrees with that of sampled points") {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> between(-1, 1);
  const auto vector = [&] {
    return Vector3d(between(generator), between(generator), between(generator));
  };
  for (int i = 0; i < 30; ++i) {
    const Vector3d size = vector().cwiseAbs() + Vector3d::Constant(0.2);
    const Quaterniond q = quaternion_from_rpy(3 * vector());
    const Model box = vehicle_of(collision_of(ShapeKind::box, size));
    const World world = world_of(i % 2 ? ShapeKind::box : ShapeKind::cylinder,
                                 vector().cwiseAbs() + Vector3d::Constant(0.2), 3 * vector(),
                                 quaternion_from_rpy(vector()));
    const double found = distance(box, world, {0, 0, 0}, q);
    double sampled = INFINITY;
    constexpr int n = 60;  // points along an edge
    for (int face = 0; face < 6; ++face) {
      for (int a = 0; a <= n; ++a) {
        for (int b = 0; b <= n; ++b) {
          Vector3d p;
          p[face / 2] = face % 2 ? 0.5 : -0.5;
          p[(face / 2 + 1) % 3] = static_cast<double>(a) / n - 0.5;
          p[(face / 2 + 2) % 3] = static_cast<double>(b) / n - 0.5;
          sampled = std::min(sampled, distance_to(world.obstacles[0], q * p.cwiseProduct(size)));
        }
      }
    }
    sampled = std::max(sampled, 0.0);
    CHECK(found <= sampled + 1e-6);
    CHECK(found >= sampled - size.maxCoeff() / n);
  }
}

TEST_CASE("an edge that touches a nearly parallel face is found") {
  const Vector3d half(0.25, 0.25, 0.05);
  const Model box = vehicle_of(collision_of(ShapeKind::box, 2 * half));
  const World slab = world_of(ShapeKind::box, {1, 1, 0.2}, {0, 0, 0});
  for (const double tilt : {1e-3, 5e-3, 0.01, 0.03, 0.05}) {
    const double drop = half.x() * std::sin(tilt) + half.z() * std::cos(tilt);
    const Quaterniond q(Eigen::AngleAxisd(tilt, Vector3d::UnitY()));
    CHECK(distance(box, slab, {0, 0, 0.1 + drop - 5e-4}, q) < 1e-5);  // 0.5 mm inside
    CHECK(distance(box, slab, {0, 0, 0.1 + drop + 5e-4}, q) == doctest::Approx(5e-4).epsilon(0.01));
  }
}
