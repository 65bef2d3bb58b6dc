#include <cmath>

#include "lopsided.hpp"
#include "states.hpp"

using namespace quadcore;
using namespace quadcore::test;

TEST_CASE("angles of joints stay between -pi and pi, and go on from there") {
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto engine = make_engine(info.name, lopsided(false), weightless());
    VehicleState state = blank(3);
    state.rotor_angle << 3.1, -3.1, 1;
    state.rotor_velocity << 100, -90, 10;
    engine->set_state(state);
    engine->step(0, 1e-3, NoForces());
    const Vector3d rates(engine->kinematics().rotors[0].rate, engine->kinematics().rotors[1].rate,
                         engine->kinematics().rotors[2].rate);
    engine->get_state(state);
    const Vector3d turned = Vector3d(3.1 - 2 * M_PI, 2 * M_PI - 3.1, 1) + 1e-3 * rates;
    CHECK((state.rotor_angle - turned).norm() < 1e-3);
  }
}

TEST_CASE("a rotor on a turning link comes back with its angle, and shows its true place") {
  const Model m = model(
      link("frame", 1, skew_body) +
      link("ring", 0.1, round_rotor, "xyz=\"0.01 0.02 0.03\" rpy=\"0.1 0 0.2\"") +
      joint("tilt", "continuous", "frame", "ring", "xyz=\"0.1 0 0.05\" rpy=\"0.4 -0.3 1\"") +
      link("rotor", 0.02, round_rotor, "xyz=\"0 0.01 0.02\"") +
      joint("turn", "continuous", "ring", "rotor", "xyz=\"0 0.2 0.01\" rpy=\"0.7 0.2 -0.5\""));
  for (const char* name : {"gazebo11", "ode"}) {
    CAPTURE(name);
    const auto engine = make_engine(name, m, World{});
    const VehicleState wanted = random_state(11, 2);
    VehicleState found = blank(2);
    engine->set_state(wanted);
    engine->get_state(found);
    CHECK((found.rotor_angle - wanted.rotor_angle).norm() < 1e-11);
    CHECK((found.rotor_velocity - wanted.rotor_velocity).norm() < 1e-11);
    const auto turned = [](double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitZ()); };
    const Matrix3d ring =
        (quaternion_from_rpy({0.4, -0.3, 1}) * turned(wanted.rotor_angle[0])).toRotationMatrix();
    const Matrix3d rotor =
        ring *
        (quaternion_from_rpy({0.7, 0.2, -0.5}) * turned(wanted.rotor_angle[1])).toRotationMatrix();
    CHECK((engine->kinematics().R_FR(0) - ring).norm() < 1e-12);
    CHECK((engine->kinematics().R_FR(1) - rotor).norm() < 1e-12);
    CHECK(
        (engine->kinematics().rotors[1].p_FRcm_F -
         (Vector3d(0.1, 0, 0.05) + ring * Vector3d(0, 0.2, 0.01) + rotor * Vector3d(0, 0.01, 0.02)))
            .norm() < 1e-12);
  }
}

TEST_CASE("a state that is set leaves nothing of the flight before, on the ground neither") {
  const Model m = read_model(Document::read(TEST_DATA "/gazebo11/cases/C1_drop/model.urdf"));
  World world;
  world.ground_plane = true;
  for (const char* name : {"gazebo11", "ode"}) {
    CAPTURE(name);
    const auto landed = make_engine(name, m, world), fresh = make_engine(name, m, world);
    VehicleState state = blank(4);
    state.position.z() = 0.02;
    landed->set_state(state);
    for (int i = 0; i < 200; ++i) landed->step(0, 1e-3, NoForces());
    state.position = {0.1, -0.2, 0.0124};
    state.angular_velocity = {0.1, 0.2, -0.3};
    for (Engine* engine : {landed.get(), fresh.get()}) engine->set_state(state);
    CHECK(landed->save() == fresh->save());
    for (int i = 0; i < 10; ++i) {
      landed->step(0, 1e-3, NoForces());
      fresh->step(0, 1e-3, NoForces());
    }
    CHECK(landed->save() == fresh->save());
  }
}

TEST_CASE("a state that is set leaves nothing of a step that failed") {
  struct Beyond final : ForceField {
    void evaluate(Kinematics&, Loads& loads) const override {
      loads.add_frame_force(0, {3e305, 0, 0}, {0, 1, 0});
      loads.add_frame_torque(0, {1, 2, 3e305});
    }
  };
  for (const char* name : {"gazebo11", "ode"}) {
    CAPTURE(name);
    for (const double friction : {0.0, 1e-3}) {
      CAPTURE(friction);
      const auto failed = make_engine(name, lopsided(true, friction), World{});
      const auto fresh = make_engine(name, lopsided(true, friction), World{});
      try {
        for (int i = 0; i < 20; ++i) failed->step(0, 1e-3, Beyond());
        CHECK_FALSE(failed->kinematics().w_WF_F.allFinite());
      } catch (const Error&) {  // from ODE, which gave up
      }
      for (Engine* engine : {failed.get(), fresh.get()}) {
        engine->set_state(random_state(5, 3));
        engine->step(0, 1e-3, NoForces());
      }
      CHECK(failed->save() == fresh->save());
    }
  }
}

TEST_CASE("a vehicle stands upright at first, and an orientation need not be of unit length") {
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto engine = make_engine(info.name, lopsided(false), weightless());
    CHECK(engine->kinematics().q_WF.coeffs() == Quaterniond::Identity().coeffs());
    VehicleState state = random_state(7, 3);
    const Quaterniond unit = state.orientation;
    state.orientation.coeffs() *= 3;
    engine->set_state(state);
    CHECK((engine->kinematics().q_WF.coeffs() - unit.coeffs()).norm() < 1e-15);
    engine->get_state(state);
    CHECK((state.orientation.coeffs() - unit.coeffs()).norm() < 1e-15);
  }
}

TEST_CASE("what is saved is restored bit for bit, in another engine of the kind too") {
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto first = make_engine(info.name, hexarotor(), World{});
    const auto second = make_engine(info.name, hexarotor(), World{});
    first->set_state(random_state(8, 6));
    for (int i = 0; i < 100; ++i) first->step(0, 1e-3, NoForces());
    second->restore(first->save());
    CHECK(second->save() == first->save());
    for (int i = 0; i < 100; ++i) {
      first->step(0, 1e-3, NoForces());
      second->step(0, 1e-3, NoForces());
    }
    CHECK(second->save() == first->save());
    CHECK(contains(refusal([&] { first->restore({1, 2, 3}); }), "another model or engine"));
  }
}
