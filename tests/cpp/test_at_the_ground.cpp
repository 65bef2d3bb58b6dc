#include <cmath>
#include <vector>

#include "grounded.hpp"
#include "lowest_point.hpp"

using namespace quadcore;
using namespace quadcore::test;

TEST_CASE("a vehicle that has come to rest stays where it is, on a slope too") {
  for (const auto& [lean, steps] : {std::pair(0.0, 60000), std::pair(0.4, 10000)}) {
    CAPTURE(lean);
    const auto engine = make_engine("eigen", vehicle(), ground(lean, 0.7));
    VehicleState state = blank(1);
    state.position.z() = 0.25;
    state.orientation = quaternion_from_rpy({0.3, -0.2, 1});
    engine->set_state(state);
    fly(*engine, 5000);
    const Vector3d before = state_of(*engine).position;
    fly(*engine, steps);
    const VehicleState after = state_of(*engine);
    CHECK((after.position - before).norm() < 1e-7);
    CHECK(after.linear_velocity.norm() < 1e-9);
  }
}

TEST_CASE("eigen touches the ground when gazebo11 does") {
  for (const char* geometry : {"<box size=\"0.3 0.2 0.1\"/>", "<sphere radius=\"0.07\"/>",
                               "<cylinder radius=\"0.15\" length=\"0.1\"/>"}) {
    CAPTURE(geometry);
    const Model m = bare(geometry);
    const auto touches = [&](const char* name) {
      const auto engine = make_engine(name, m, ground());
      VehicleState state = blank(0);
      state.position.z() = 0.7;
      state.orientation = quaternion_from_rpy({0.5, -0.3, 1});
      engine->set_state(state);
      double before = lowest_point(m, engine->kinematics());
      for (int i = 0;; ++i) {
        engine->step(i * dt, dt, NoForces());
        const double after = lowest_point(m, engine->kinematics());
        if (after <= 0) return dt * (i + before / (before - after));
        before = after;
      }
    };
    // Gazebo's Euler steps are half a step ahead in a fall.
    CHECK(touches("eigen") - touches("gazebo11") == doctest::Approx(dt / 2).epsilon(1e-3));
  }
}

TEST_CASE("flights on the ground go on from a snapshot with the same bytes") {
  const Model m = vehicle();
  const auto flown = make_engine("eigen", m, ground(0.2, 0.4));
  const auto restored = make_engine("eigen", m, ground(0.2, 0.4));
  VehicleState state = blank(1);
  state.position.z() = 0.2;
  state.linear_velocity = {1, 0.5, -1};
  state.rotor_velocity[0] = 300;
  flown->set_state(state);
  fly(*flown, 20);
  for (int i = 0; i < 40; ++i) {
    const std::vector<double> before = flown->save();
    fly(*flown, 13);
    restored->restore(before);
    fly(*restored, 13);
    CHECK(restored->save() == flown->save());
  }
}

TEST_CASE("away from the ground a flight is that in a world without it") {
  const Model m = vehicle();
  const auto over_ground = make_engine("eigen", m, ground());
  const auto in_space = make_engine("eigen", m, World{});
  VehicleState state = random_state(3, 1);
  state.position.z() = 40;
  for (Engine* engine : {over_ground.get(), in_space.get()}) {
    engine->set_state(state);
    fly(*engine, 1000);
  }
  std::vector<double> expected = in_space->save(), found = over_ground->save();
  found.resize(expected.size());
  CHECK(found == expected);
}

TEST_CASE("a vehicle that is put into the ground is not thrown up but refused") {
  const Model m = bare("<box size=\"0.3 0.2 0.1\"/>");
  const auto engine = make_engine("eigen", m, ground());
  VehicleState state = blank(0);
  engine->set_state(state);
  std::string said;
  try {
    engine->step(0, dt, NoForces());
  } catch (const Error& error) {
    said = error.what();
  }
  CHECK(contains(said, "starts 0.02 m deep in the ground"));
  CHECK(contains(said, "Start at z = 0.02 or above"));
  state.position.z() = 0.02 - 1e-5;  // as gazebo11 may leave one
  engine->set_state(state);
  fly(*engine, 1000);
  CHECK(state_of(*engine).position.z() == doctest::Approx(0.02).epsilon(1e-2));
}
