#include <memory>

#include "ode/world_contact.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

constexpr double dt = 1e-3;

/// A frame without shapes and a rotor with a box of 0.6 x 0.8 x 2.4 m (diagonal 2.6 m), whose
/// centre sits 2 m along y from the rotor's centre of mass.
Model boxed() {
  std::string rotor = link("rotor", 0.1, round_rotor);
  rotor.insert(rotor.find("</link>"),
               "<collision><origin xyz=\"0 2 0\"/><geometry><box size=\"0.6 0.8 2.4\"/></geometry>"
               "</collision>");
  return model(link("frame", 1, skew_body) + rotor +
               joint("turn", "continuous", "frame", "rotor", "xyz=\"0.3 0 0\""));
}

/// Whether the box may be below the ground within 0.1 s, from so high above it.
bool is_ahead(double height, const Vector3d& v_W, const Vector3d& w_W, double gravity_z) {
  const std::unique_ptr<dxWorld, void (*)(dWorldID)> world(dWorldCreate(), &dWorldDestroy);
  const std::vector<dBodyID> bodies = {dBodyCreate(world.get()), dBodyCreate(world.get())};
  dBodySetAngularVel(bodies[0], w_W.x(), w_W.y(), w_W.z());
  dBodySetAngularVel(bodies[1], 7, 8, 900);  // of the rotor itself: not asked for
  dBodySetPosition(bodies[0], 5, 6, -100);   // without shapes
  dBodySetPosition(bodies[1], 5, 6, 1.2 + height);
  dBodySetLinearVel(bodies[1], v_W.x(), v_W.y(), v_W.z());
  World grounded;
  grounded.ground_plane = true;
  grounded.gravity_W.z() = gravity_z;
  const Model vehicle = boxed();
  return WorldContact({&vehicle}, bodies, grounded).is_ahead(0.1);
}

/// Whether the box is seen ahead just below a height, and not just above.
void check_height(double height, const Vector3d& v_W, const Vector3d& w_W, double gravity_z) {
  CAPTURE(height);
  CHECK(is_ahead(height - 1e-9, v_W, w_W, gravity_z));
  CHECK_FALSE(is_ahead(height + 1e-9, v_W, w_W, gravity_z));
}

/// A ball of a frame with a rotor askew and turning, over the ground or none.
std::unique_ptr<Engine> ball(const World& world) {
  std::string frame = link("frame", 1, skew_body);
  frame.insert(frame.find("</link>"),
               "<collision><geometry><sphere radius=\"0.5\"/></geometry></collision>");
  return make_engine(
      "gazebo11",
      model(frame + link("rotor", 0.1, skew_body) +
            joint("turn", "continuous", "frame", "rotor", "xyz=\"0.3 0.1 0\" rpy=\"0.5 1 0.1\"")),
      world);
}

VehicleState above_ground(double height) {
  VehicleState state;
  state.position = {0, 0, 0.5 + height};
  state.angular_velocity = {3e-4, -2e-4, 5e-4};
  state.rotor_velocity = VectorXd::Constant(1, 40);
  state.rotor_angle = VectorXd::Constant(1, 0.3);
  return state;
}

/// What a step leads to.
std::vector<double> stepped(double height, const Vector3d& gravity_W, bool with_ground) {
  World world;
  world.ground_plane = with_ground;
  world.gravity_W = gravity_W;
  const auto engine = ball(world);
  VehicleState state = above_ground(height);
  engine->set_state(state);
  engine->step(0, dt, NoForces());
  engine->get_state(state);
  const Vector3d &v = state.linear_velocity, &w = state.angular_velocity;
  return {v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), state.rotor_velocity[0]};
}

}  // namespace

TEST_CASE("a touch is seen ahead by the fall, the velocity and the turning of a shape") {
  dInitODE2(0);
  const Vector3d still(0, 0, 0);
  check_height(0.049, still, still, -9.8);  // g t^2 / 2
  CHECK_FALSE(is_ahead(0, still, still, 0));
  check_height(0, still, still, 9.8);  // what falls upwards does not come down by it
  check_height(0.02, {9, 9, -0.2}, still, 0);
  check_height(0.049 - 0.03, {0, 0, 0.3}, still, -9.8);
  // The frame's turning moves the centre of the box by w_x 2 m, and any of its points by |w| 1.3 m.
  check_height(0.5 * 1.3 * 0.1, still, {0, 0.3, 0.4}, 0);
  check_height((0.5 * 1.3 - 0.3 * 2) * 0.1, still, {0.3, 0, 0.4}, 0);
  check_height((0.5 * 1.3 + 0.3 * 2) * 0.1 + 0.049, still, {-0.3, 0, 0.4}, -9.8);
}

TEST_CASE("Gazebo's sweeps begin fifty steps before a fall may end on the ground") {
  const auto same = [](double height, const Vector3d& gravity_W) {
    return stepped(height, gravity_W, true) == stepped(height, gravity_W, false);
  };
  const double fall = 9.8 * 0.05 * 0.05 / 2, turning = 0.05 * 1e-3;
  CHECK_FALSE(same(fall - turning, {0, 0, -9.8}));
  CHECK(same(fall + 2 * turning, {0, 0, -9.8}));
  CHECK(same(fall - turning, {-9.8, 0, 0}));
  CHECK(same(fall - turning, {0, -9.8, 0}));
}

TEST_CASE("how long ago a contact was is part of what is saved") {
  World world;
  world.ground_plane = true;
  const auto leaving = ball(world), other = ball(world), without = ball(World{});
  VehicleState state = above_ground(-1e-4);
  state.linear_velocity.z() = 5;  // no touch is ahead
  leaving->set_state(state);
  for (int i = 0; i < 5; ++i) leaving->step(0, dt, NoForces());
  for (Engine* engine : {other.get(), without.get()}) engine->restore(leaving->save());
  for (Engine* engine : {leaving.get(), other.get(), without.get()})
    engine->step(0, dt, NoForces());
  CHECK(other->save() == leaving->save());
  CHECK(without->kinematics().w_WF_F != leaving->kinematics().w_WF_F);  // solved directly
}
