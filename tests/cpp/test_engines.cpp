#include <thread>

#include "lopsided.hpp"
#include "lowest_point.hpp"
#include "states.hpp"

using namespace quadcore;
using namespace quadcore::test;

TEST_CASE(
    "a state that is set comes back, whatever the centre of mass and the tilt of the rotors") {
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto engine = make_engine(info.name, hexarotor(), World{});
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const VehicleState wanted = random_state(seed, 6);
      VehicleState found = blank(6);
      engine->set_state(wanted);
      engine->get_state(found);
      CHECK((found.position - wanted.position).norm() < 1e-13);
      CHECK(found.orientation.angularDistance(wanted.orientation) < 1e-7);
      CHECK((found.linear_velocity - wanted.linear_velocity).norm() < 1e-13);
      CHECK((found.angular_velocity - wanted.angular_velocity).norm() < 1e-13);
      CHECK((found.rotor_velocity - wanted.rotor_velocity).norm() < 1e-11);
      CHECK((found.rotor_angle - wanted.rotor_angle).norm() < 1e-11);
    }
  }
}

TEST_CASE("the velocities that a force law sees are the rates of the places it sees") {
  constexpr double dt = 1e-6;
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto engine = make_engine(info.name, lopsided(info.name != "eigen"), weightless());
    engine->set_state(random_state(5, 3));
    const Kinematics before = engine->kinematics();
    engine->step(0, dt, NoForces());
    const Kinematics& after = engine->kinematics();
    const auto rate_F = [&](const Vector3d& p, const Vector3d& q) -> Vector3d {
      return before.R_WF.transpose() * (q - p) / dt;
    };
    const auto place = [](const Kinematics& k, const Vector3d& p_F) -> Vector3d {
      return k.p_WF + k.R_WF * p_F;
    };
    constexpr double tolerance = 1e-3;  // an acceleration of 1000 m/s^2 over the step
    CHECK((rate_F(before.p_WF, after.p_WF) - before.v_WF_F).norm() < tolerance);
    CHECK((rate_F(place(before, before.p_FCcm_F), place(after, after.p_FCcm_F)) - before.v_WCcm_F)
              .norm() < tolerance);
    const Matrix3d turn = before.R_WF.transpose() * (after.R_WF - before.R_WF) / dt;
    CHECK((turn - skew(before.w_WF_F)).norm() < tolerance);
    for (std::size_t i = 0; i < 3; ++i) {
      const RotorKinematics& a = before.rotors[i];
      const RotorKinematics& b = after.rotors[i];
      CHECK((rate_F(place(before, a.p_FRcm_F), place(after, b.p_FRcm_F)) - a.v_WRcm_F).norm() <
            tolerance);
      CHECK((after.rotors.vector(MotionRow::normal, i) - after.R_FR(i).col(2)).norm() < 1e-14);
      const Vector3d& p_RRcm = engine->model().links[i + 1].inertial.pose.xyz;
      const Vector3d p_FR_F = a.p_FRcm_F - before.R_FR(i) * p_RRcm;
      const Vector3d q_FR_F = b.p_FRcm_F - after.R_FR(i) * p_RRcm;
      CHECK((rate_F(place(before, p_FR_F), place(after, q_FR_F)) - a.v_WR_F).norm() < tolerance);
      CHECK(std::abs(std::remainder(after.angle(i) - before.angle(i), 2 * M_PI) / dt - a.rate) <
            tolerance);
      CHECK(a.axis_F.norm() == doctest::Approx(1));
      if (engine->model().joints[i].parent != 0) continue;
      // The joint turns the rotor about its axis, seen from the frame.
      const Matrix3d spin = (after.R_FR(i) - before.R_FR(i)) * before.R_FR(i).transpose() / dt;
      CHECK((spin - skew(a.rate * a.axis_F)).norm() < 0.1);
    }
  }
}

TEST_CASE("the normal of a rotor that turns about another axis turns with it") {
  std::string turning = joint("turn", "continuous", "frame", "rotor");
  turning.replace(turning.find("0 0 1\"/>"), 5, "1 0 0");
  const Model m = model(
      link("frame", 1, skew_body) +
      link("rotor", 0.01, "ixx=\"2e-5\" iyy=\"1e-5\" izz=\"1e-5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"") +
      turning);
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto engine = make_engine(info.name, m, weightless());
    VehicleState state = blank(1);
    state.rotor_angle[0] = 0.7;
    engine->set_state(state);
    const Vector3d normal_F = engine->kinematics().rotors.vector(MotionRow::normal, 0);
    CHECK((normal_F - Vector3d(0, -std::sin(0.7), std::cos(0.7))).norm() < 1e-14);
  }
}

TEST_CASE("a load that is not finite is refused, whatever component it is") {
  struct Spoilt final : ForceField {
    int component = 0;
    void evaluate(Kinematics&, Loads& loads) const override {
      Vector3d v[4] = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
      v[component / 3][component % 3] = NAN;
      loads.add_frame_force(0, v[0], {0, 0, 0});
      loads.add_frame_torque(0, v[1]);
      loads.add_rotor_force(0, 0, v[2]);
      loads.add_joint_torque(2, v[3].x());
    }
  };
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const auto engine = make_engine(info.name, lopsided(false), weightless());
    engine->set_state(random_state(7, 3));
    Spoilt spoilt;
    for (; spoilt.component < 10; ++spoilt.component) {
      CAPTURE(spoilt.component);
      CHECK_THROWS_AS(engine->step(0, 1e-3, spoilt), Error);
    }
  }
}

TEST_CASE("an engine may be stepped in another thread than that which made it") {
  const Model m = read_model(Document::read(TEST_DATA "/gazebo11/cases/C1_drop/model.urdf"));
  World world;
  world.ground_plane = true;
  for (const char* name : {"gazebo11", "ode"}) {
    CAPTURE(name);
    const auto here = make_engine(name, m, world), elsewhere = make_engine(name, m, world);
    const auto land = [](Engine& engine) {
      for (int i = 0; i < 200; ++i) engine.step(0, 1e-3, NoForces());
    };
    land(*here);
    std::thread(land, std::ref(*elsewhere)).join();
    CHECK(here->save() == elsewhere->save());
  }
}

TEST_CASE("the lowest point of a tilted cylinder is that of its rims") {
  const Model m = model("<link name=\"frame\"><inertial><mass value=\"1\"/><inertia " + skew_body +
                        "/></inertial><collision><origin xyz=\"0.1 -0.05 0.02\" rpy=\"0.9 0.4 "
                        "-0.3\"/><geometry><cylinder radius=\"0.3\" "
                        "length=\"0.1\"/></geometry></collision></link>\n");
  const auto engine = make_engine("eigen", m, World{});
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const VehicleState state = random_state(seed, 0);
    engine->set_state(state);
    const Quaterniond q = state.orientation * quaternion_from_rpy({0.9, 0.4, -0.3});
    const Vector3d center = state.position + state.orientation * Vector3d(0.1, -0.05, 0.02);
    double lowest = 1e9;
    for (int i = 0; i < 2000; ++i) {
      const double angle = 2 * M_PI * i / 2000;
      for (const double half : {-0.05, 0.05}) {
        const Vector3d rim(0.3 * std::cos(angle), 0.3 * std::sin(angle), half);
        lowest = std::min(lowest, (center + q * rim).z());
      }
    }
    CHECK(lowest_point(m, engine->kinematics()) == doctest::Approx(lowest).epsilon(1e-6));
  }
}

TEST_CASE("whether sweeps converge is found for each vehicle, and reported") {
  const Model shipped = read_model(Document::read(TEST_DATA "/gazebo11/cases/C1_drop/model.urdf"));
  const auto method = [](const std::string& engine, const Model& model, int sweeps,
                         double cfm = 0) {
    World world;
    world.solver_iterations = sweeps;
    world.cfm = cfm;
    return make_engine(engine, model, world)->method();
  };
  CHECK(
      contains(method("gazebo11", shipped, 50), "direct solver, to which Gazebo's 50 iterations"));
  CHECK(contains(method("gazebo11", shipped, 20), "20 iterations of Gazebo's solver, which leave"));
  CHECK(contains(method("ode", shipped, 20), "direct solver"));
  // A light rotor far out on a heavy frame.
  const Model heavy = model(
      link("frame", 3, "ixx=\"0.03\" iyy=\"0.04\" izz=\"0.06\" ixy=\"0\" ixz=\"0\" iyz=\"0\"") +
      link("rotor", 0.005, "ixx=\"1e-7\" iyy=\"1e-5\" izz=\"1e-5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"") +
      joint("turn", "continuous", "frame", "rotor"));
  CHECK(contains(method("gazebo11", heavy, 50), "50 iterations of Gazebo's solver"));
  CHECK(contains(method("gazebo11", heavy, 50, 1e6), "direct solver, to which"));  // soft hinges
  CHECK(contains(method("gazebo11", heavy, 100000), "direct solver, to which"));
}

TEST_CASE("solver type world on the ground is warned of where it is written") {
  const Document document{
      "a.world",
      "<sdf><world>\n<physics><ode><solver>\n<type>world</type></solver></ode></"
      "physics>\n<include><uri>model://ground_plane</uri></include></world></sdf>"};
  World world = read_world(document);
  const auto warnings = make_engine("gazebo11", hexarotor(), world)->warnings();
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].rfind("a.world:3: the solver type world fails on the ground", 0) == 0);
  world.ground_plane = false;
  CHECK(make_engine("gazebo11", hexarotor(), world)->warnings().empty());
}

TEST_CASE("all engines show a force law the same motion") {
  const Model model = hexarotor();
  const VehicleState state = random_state(3, 6);
  const auto exact = make_engine("eigen", model, World{});
  const auto ode = make_engine("ode", model, World{});
  exact->set_state(state);
  ode->set_state(state);
  const Kinematics& a = exact->kinematics();
  const Kinematics& b = ode->kinematics();
  CHECK((a.p_FCcm_F - b.p_FCcm_F).norm() < 1e-13);
  CHECK((a.v_WCcm_F - b.v_WCcm_F).norm() < 1e-12);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK((a.rotors[i].axis_F - b.rotors[i].axis_F).norm() < 1e-13);
    CHECK((a.rotors[i].p_FRcm_F - b.rotors[i].p_FRcm_F).norm() < 1e-13);
    CHECK((a.rotors[i].v_WRcm_F - b.rotors[i].v_WRcm_F).norm() < 1e-12);
    CHECK((a.rotors[i].v_WR_F - b.rotors[i].v_WR_F).norm() < 1e-12);
    CHECK((a.R_FR(i) - b.R_FR(i)).norm() < 1e-12);
  }
}

TEST_CASE("a load counts once in the sum and in its term, about the centre of mass") {
  Kinematics kinematics(1);
  kinematics.p_FCcm_F = {0.1, 0.2, 0.3};
  kinematics.rotors.set_vector(MotionRow::p_FRcm, 0, {1.1, 0.2, 0.3});
  Loads loads(1);
  Wrench terms[2];
  loads.record_terms(terms, 2, &kinematics);
  loads.add_rotor_force(0, 0, {0, 0, 2});
  loads.add_frame_force(1, {0, 3, 0}, {0.1, 0.2, 1.3});
  loads.add_frame_torque(1, {0, 0, 5});
  loads.add_joint_torque(0, 0.25);

  CHECK(terms[0].force_F == Vector3d(0, 0, 2));
  CHECK((terms[0].torque_F - Vector3d(0, -2, 0)).norm() < 1e-15);
  CHECK(terms[1].force_F == Vector3d(0, 3, 0));
  CHECK((terms[1].torque_F - Vector3d(-3, 0, 5)).norm() < 1e-15);
  CHECK(loads.rotor_force_F(0) == Vector3d(0, 0, 2));
  CHECK(loads.frame().force_F == Vector3d(0, 3, 0));
  // About the frame's origin: (0.1, 0.2, 1.3) x (0, 3, 0) and the torque.
  CHECK((loads.frame().torque_F - Vector3d(-3.9, 0, 5.3)).norm() < 1e-15);
  CHECK(loads.joint_torque(0) == 0.25);

  const Vector3d one = Vector3d::Ones();
  CHECK_THROWS_WITH(loads.add_rotor_force(0, 1, one),
                    "a load acts on rotor 1, but rotors are numbered from 0 and there are 1");
  CHECK_THROWS_AS(loads.add_joint_torque(std::size_t(-1), 1), Error);
  for (const std::size_t term : {std::size_t(2), std::size_t(-1)}) {
    CHECK_THROWS_AS(loads.add_rotor_force(term, 0, one), Error);
    CHECK_THROWS_AS(loads.add_frame_force(term, one, one), Error);
    CHECK_THROWS_AS(loads.add_frame_torque(term, one), Error);
  }
  loads.clear();
  CHECK(loads.frame().force_F.isZero(0));
  CHECK(loads.rotor_force_F(0).isZero(0));
  CHECK(loads.joint_torque(0) == 0);
}

TEST_CASE("an unknown engine is refused with those there are") {
  const std::string message = refusal([] { make_engine("gazebo", hexarotor(), World{}); });
  CHECK(contains(message, "Did you mean 'gazebo11'?"));
  for (const EngineInfo& info : engines()) CHECK(contains(message, info.name));
}
