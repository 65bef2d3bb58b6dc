#include <algorithm>
#include <string>
#include <vector>

#include "eigen/gyrostat.hpp"
#include "eigen/obstacle_depth.hpp"
#include "grounded.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

Obstacle obstacle(ShapeKind kind, const Vector3d& size, const Vector3d& position,
                  const Vector3d& rpy = {0, 0, 0}) {
  Obstacle made;
  made.model = "thing";
  made.kind = kind;
  made.size = size;
  made.position_W = position;
  made.orientation_W = quaternion_from_rpy(rpy);
  return made;
}

/// Six walls around a cube of 3 m, and in it a box, two poles and a ball.
std::vector<Obstacle> room() {
  std::vector<Obstacle> all;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vector3d size = Vector3d::Constant(4), position(0, 0, 1.5);
      size[axis] = 0.5;
      position[axis] += side * 1.75;
      all.push_back(obstacle(ShapeKind::box, size, position));
    }
  }
  all.push_back(obstacle(ShapeKind::box, {0.4, 0.5, 0.6}, {0.6, 0.7, 0.4}, {0.1, 0.2, 0.3}));
  all.push_back(obstacle(ShapeKind::cylinder, {0.08, 3, 0}, {-0.7, 0.6, 1.5}));
  all.push_back(obstacle(ShapeKind::cylinder, {0.05, 3, 0}, {0, -0.8, 1.2}, {1.2, 0, 0.4}));
  all.push_back(obstacle(ShapeKind::sphere, {0.3, 0, 0}, {-0.6, -0.7, 0.5}));
  return all;
}

/// A vehicle of random mass and shapes, some with a shape that turns.
Model random_vehicle(std::uint64_t seed) {
  std::uint64_t count = 0;
  const auto pick = [&](double least, double most) {
    const double unit = static_cast<double>(random_bits(seed, count++) >> 11) * 0x1p-53;
    return std::to_string(least + (most - least) * unit);
  };
  std::string text = shaped(
      "frame",
      shape("<box size=\"" + pick(0.1, 0.4) + " " + pick(0.1, 0.4) + " " + pick(0.03, 0.1) + "\"/>",
            "xyz=\"0.01 0.02 -0.03\" rpy=\"0.1 -0.2 0.3\"") +
          shape("<sphere radius=\"" + pick(0.02, 0.06) + "\"/>", "xyz=\"-0.1 0.05 -0.08\"") +
          shape("<cylinder radius=\"" + pick(0.02, 0.1) + "\" length=\"" + pick(0.05, 0.3) + "\"/>",
                "xyz=\"0.1 -0.1 0.02\" rpy=\"0.4 0.2 0\""),
      inertial(pick(0.4, 3), skew_body, "xyz=\"0.01 -0.02 0.03\""));
  for (int i = 0; i < static_cast<int>(seed % 4); ++i) {
    const std::string name = "rotor" + std::to_string(i);
    const std::string blade = (seed + static_cast<std::uint64_t>(i)) % 3
                                  ? "<cylinder radius=\"0.1\" length=\"0.01\"/>"
                                  : "<box size=\"0.2 0.03 0.01\"/>";
    text += shaped(name, shape(blade), inertial("0.02", round_rotor)) + "<joint name=\"turn" +
            name + "\" type=\"continuous\"><parent link=\"frame\"/><child link=\"" + name +
            "\"/><origin xyz=\"" + pick(-0.2, 0.2) + " " + pick(-0.2, 0.2) +
            " 0.08\" rpy=\"0.1 0 0\"/><axis xyz=\"0 0 1\"/></joint>";
  }
  return model(text);
}

/// Return the kinetic energy and that of the height over the floor [J].
double energy_of(const Model& m, const Gyrostat& body, Engine& engine) {
  const Kinematics& k = engine.kinematics();
  const double height = (k.p_WF + k.R_WF * body.p_FCcm_F).z();
  double sum = (k.v_WCcm_F.squaredNorm() / 2 + g * height) / body.inverse_mass +
               k.w_WF_F.dot(body.inverse_reduced_I_F.inverse() * k.w_WF_F) / 2;
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const double rate = k.rotors[i].rate + k.rotors[i].axis_F.dot(k.w_WF_F);
    sum += moment_about_joint(m, i) * rate * rate / 2;
  }
  return sum;
}

World world_of(const std::vector<Obstacle>& obstacles) {
  World world;
  world.obstacles = obstacles;
  return world;
}

}  // namespace

TEST_CASE("the normal of a depth is minus its gradient") {
  const std::vector<Obstacle> all = room();
  double count = 0;
  for (int i = 0; i < 400; ++i) {
    const Obstacle& one = all[static_cast<std::size_t>(i) % all.size()];
    const double radius = i % 2 ? 0.1 : 0;
    const Vector3d p_W = one.position_W + 0.4 * random_vector(3, count);
    const ObstacleDepth found = find_depth(one, p_W, radius);
    constexpr double step = 1e-6;
    const double out = find_depth(one, p_W + step * found.normal_W, radius).depth;
    CHECK(found.normal_W.norm() == doctest::Approx(1));
    CHECK((found.depth - out) / step == doctest::Approx(1).epsilon(1e-6));
    if (radius == 0) CHECK(found.depth == doctest::Approx(-distance_to(one, p_W)).epsilon(1e-9));
  }
}

TEST_CASE(
    "a vehicle that is thrown at a room of obstacles never has more energy than at its start") {
  const World world = world_of(room());
  int touched = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const Model m = random_vehicle(seed);
    const Gyrostat body(m);
    const auto engine = make_engine("eigen", m, world);
    VehicleState state = random_state(seed, static_cast<Eigen::Index>(m.joints.size()));
    state.position = {0, 0, 1.7};
    state.angular_velocity *= 3;
    engine->set_state(state);
    const double begin = energy_of(m, body, *engine);
    double most = begin;
    fly(*engine, 1000, [&] { most = std::max(most, energy_of(m, body, *engine)); });
    CHECK(most <= begin * (1 + 1e-6));
    touched += energy_of(m, body, *engine) < 0.9 * begin;
    const Vector3d from_middle = state_of(*engine).position - Vector3d(0, 0, 1.5);
    CHECK(from_middle.cwiseAbs().maxCoeff() < 1.7);
  }
  CHECK(touched > 50);
}

TEST_CASE("a vehicle rests on a box, and does not slide") {
  const auto engine = make_engine("eigen", vehicle(),
                                  world_of({obstacle(ShapeKind::box, {2, 2, 1}, {0, 0, -0.5})}));
  VehicleState state = blank(1);
  state.position.z() = 0.3;
  engine->set_state(state);
  fly(*engine, 3000);
  const VehicleState before = state_of(*engine);
  fly(*engine, 1000);
  const VehicleState after = state_of(*engine);
  CHECK(after.position.z() > 0);
  CHECK((after.position - before.position).norm() < 1e-6);
  CHECK(after.linear_velocity.norm() < 1e-6);
}

TEST_CASE(
    "a box slides on another one by the laws of friction, whatever the direction of its normal") {
  // A cube slides down a wall that presses on it: gravity along the wall, and towards it.
  const Model m = bare("<box size=\"0.3 0.3 0.3\"/>",
                       "<gazebo reference=\"frame\"><mu1>0.3</mu1><mu2>0.3</mu2></gazebo>");
  for (int side = 0; side < 6; ++side) {
    CAPTURE(side);
    const int axis = side % 3, sign = side < 3 ? 1 : -1;
    Vector3d size = Vector3d::Constant(20), position(0.02, -0.01, 0.03);
    position[axis] -= sign * (0.15 + 10);
    World world = world_of({obstacle(ShapeKind::box, size, position)});
    world.gravity_W = Vector3d::Zero();
    world.gravity_W[axis] = -10 * sign;
    world.gravity_W[(axis + 1) % 3] = 6;
    const auto engine = make_engine("eigen", m, world);
    VehicleState state = blank(0);
    engine->set_state(state);
    fly(*engine, 300);
    const double before = state_of(*engine).linear_velocity[(axis + 1) % 3];
    fly(*engine, 200);
    const double gained = state_of(*engine).linear_velocity[(axis + 1) % 3] - before;
    CHECK(gained / 0.2 == doctest::Approx(6 - 0.3 * 10).epsilon(0.02));
  }
}

TEST_CASE("friction holds a vehicle that is wedged between two walls, but not beside one") {
  const Model m = bare("<box size=\"0.2 0.2 0.2\"/>", "");
  for (const bool turned : {false, true}) {
    CAPTURE(turned);
    VehicleState state = blank(0);
    if (turned) state.orientation = Eigen::AngleAxisd(0.9, Vector3d::UnitZ());
    const Vector3d middle(0.02, -0.01, 0.03);  // of the shape
    std::vector<Obstacle> walls;
    for (const double x : {1.1 - 1e-6, -1.1 + 2e-6}) {
      walls.push_back(
          obstacle(ShapeKind::box, {2, 4, 9}, state.orientation * (middle + Vector3d(x, 0, 0))));
      walls.back().orientation_W = state.orientation;
    }
    const auto between = make_engine("eigen", m, world_of(walls));
    const auto beside = make_engine("eigen", m, world_of({walls[0]}));
    for (Engine* engine : {between.get(), beside.get()}) {
      engine->set_state(state);
      fly(*engine, 1000);
    }
    CHECK(state_of(*between).position.z() > -0.01);
    CHECK(state_of(*beside).position.z() < -4);
  }
}

TEST_CASE("tags of obstacles that have no effect are named once") {
  Obstacle slippery = obstacle(ShapeKind::box, {2, 2, 1}, {0, 0, -0.5});
  slippery.where = "a.world:7";
  slippery.slip1 = 0.1;
  const auto engine = make_engine("eigen", vehicle(), world_of({slippery, slippery}));
  REQUIRE(engine->warnings().size() == 1);
  CHECK(engine->warnings()[0] ==
        "a.world:7: the engine eigen ignores <slip1>, <slip2> and <bounce> of 'thing' and 1 more "
        "obstacles. Use the engine ode or gazebo11 to include them.");
}

TEST_CASE("away from obstacles a vehicle moves as in the empty world, to the bit") {
  const Model m = vehicle();
  const auto alone = make_engine("eigen", m, World{});
  const auto there = make_engine("eigen", m, world_of(room()));
  VehicleState state = random_state(1, 1);
  state.position = {30, 0, 50};
  for (Engine* engine : {alone.get(), there.get()}) {
    engine->set_state(state);
    fly(*engine, 500);
  }
  CHECK(state_of(*alone).position == state_of(*there).position);
  CHECK(state_of(*alone).angular_velocity == state_of(*there).angular_velocity);
}

TEST_CASE("a saved contact goes on as if it had not been saved") {
  const Model m = vehicle();
  World world = world_of(room());
  world.ground_plane = true;
  const auto one = make_engine("eigen", m, world);
  const auto other = make_engine("eigen", m, world);
  VehicleState state = random_state(5, 1);
  state.position = {0, 0, 1.7};
  one->set_state(state);
  fly(*one, 400);
  other->restore(one->save());
  fly(*one, 200);
  fly(*other, 200);
  CHECK(one->save() == other->save());
}

TEST_CASE("meshes and a start deep in an obstacle are refused by name") {
  Obstacle mesh = obstacle(ShapeKind::mesh, {1, 1, 1}, {0, 0, 0});
  mesh.where = "a.world:3";
  CHECK(contains(refusal([&] { make_engine("eigen", vehicle(), world_of({mesh})); }),
                 "a.world:3: the engine eigen does not model the mesh of 'thing'"));
  const auto engine =
      make_engine("eigen", vehicle(), world_of({obstacle(ShapeKind::box, {2, 2, 1}, {0, 0, 0})}));
  engine->set_state(blank(1));
  std::string message;
  try {
    fly(*engine, 1);
  } catch (const Error& error) {
    message = error.what();
  }
  CHECK(contains(message, "m deep in 'thing'"));
}
