#include <algorithm>
#include <vector>

#include "eigen/contact_stiffness.hpp"
#include "eigen/touching_points.hpp"
#include "grounded.hpp"
#include "lowest_point.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

/// Of a vehicle: of its motion, height and springs [J]; those of friction store more, if anything.
struct Energy {
  Model m;
  Gyrostat body = Gyrostat(m);
  Matrix3d reduced_I_F = body.inverse_reduced_I_F.inverse();
  std::vector<StableContact> stable = stable_contacts(m, body);

  double operator()(Engine& engine) const {
    const Kinematics& k = engine.kinematics();
    const double height = (k.p_WF + k.R_WF * body.p_FCcm_F).z();
    double sum = (k.v_WCcm_F.squaredNorm() / 2 + g * height) / body.inverse_mass +
                 k.w_WF_F.dot(reduced_I_F * k.w_WF_F) / 2;
    for (std::size_t i = 0; i < m.joints.size(); ++i) {
      const double rate = k.rotors[i].rate + k.rotors[i].axis_F.dot(k.w_WF_F);
      sum += moment_about_joint(m, i) * rate * rate / 2;
    }
    std::size_t shape = 0;
    for (std::size_t i = 0; i < m.links.size(); ++i) {
      const Matrix3d R_WL = i == 0 ? k.R_WF : (k.R_WF * k.R_FR(i - 1)).eval();
      const Vector3d p_WL = i == 0 ? k.p_WF : (k.p_WF + k.R_WF * k.rotors[i - 1].p_FRcm_F).eval();
      for (const Collision& collision : m.links[i].collisions) {
        const double stiffness = stable[shape++].pressing / std::pow(dt / 4, 2);
        Vector3d points[most_touching_points];
        const int count = touching_points(collision, p_WL + R_WL * collision.pose.xyz,
                                          R_WL * collision.pose.rotation(), points);
        for (int j = 0; j < count; ++j) {
          sum += stiffness * std::pow(std::min(0.0, points[j].z()), 2) / 2;
        }
      }
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("a vehicle rests as deep as its weight on the springs of its points") {
  const std::pair<const char*, std::pair<int, double>> cases[] = {
      {"<box size=\"0.3 0.2 0.1\"/>", {4, 0.05}},
      {"<cylinder radius=\"0.15\" length=\"0.1\"/>", {4, 0.05}},
      {"<sphere radius=\"0.07\"/>", {1, 0.07}}};
  for (const auto& [geometry, expected] : cases) {
    CAPTURE(geometry);
    const auto [points, half] = expected;
    const Model m = bare(geometry);
    const double stiffness = stable_contacts(m, Gyrostat(m))[0].pressing / std::pow(dt / 4, 2);
    const auto engine = make_engine("eigen", m, ground());
    VehicleState state = blank(0);
    state.position.z() = half - 0.03 + 0.01;
    engine->set_state(state);
    fly(*engine, 3000);
    const double depth = half - 0.03 - state_of(*engine).position.z();
    CHECK(depth == doctest::Approx(1.3 * g / (points * stiffness)).epsilon(1e-6));
    CHECK(depth < 2e-4);
  }
}

TEST_CASE("springs are as stiff as the step can follow, and softer where a tag says so") {
  // A ball of mass m, moment I and radius r about its middle: the largest square is bounded by
  // twice the larger of 1/m and r^2/I.
  const std::string round = "<sphere radius=\"0.1\"/>";
  const auto ball_of = [&](const std::string& tags) {
    return model(shaped("ball", shape(round), inertial("2", round_body)) + tags);
  };
  const Model stiff = ball_of("");
  const double expected = 0.25 / (2 * std::max(1 / 2.0, 0.01 / 0.01));
  CHECK(stable_contacts(stiff, Gyrostat(stiff))[0].pressing == doctest::Approx(expected));

  const Model soft = ball_of("<gazebo reference=\"ball\"><kp>5000</kp></gazebo>");
  const auto engine = make_engine("eigen", soft, ground());
  VehicleState state = blank(0);
  state.position.z() = 0.1;
  engine->set_state(state);
  fly(*engine, 3000);
  CHECK(0.1 - state_of(*engine).position.z() == doctest::Approx(2 * g / 5000).epsilon(1e-6));
}

TEST_CASE("a vehicle that strikes the ground has never more energy than it began with") {
  const Model m = vehicle();
  const Energy energy{m};
  const auto engine = make_engine("eigen", m, ground());
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    VehicleState state = random_state(seed, 1);
    state.position.z() = 0;
    state.linear_velocity /= 3;
    engine->set_state(state);
    state.position.z() = 0.05 - lowest_point(m, engine->kinematics());
    engine->set_state(state);
    const double begin = energy(*engine);
    double most = begin;
    bool touched = false;
    fly(*engine, 2000, [&] {
      most = std::max(most, energy(*engine));
      touched |= lowest_point(m, engine->kinematics()) < 0;
    });
    CHECK(touched);
    CHECK(most <= begin * (1 + 1e-6));
    CHECK(energy(*engine) < 0.5 * begin);
  }
}

TEST_CASE("a body sticks below the angle of friction and slides above it as Coulomb has it") {
  const std::string tags = "<gazebo reference=\"frame\"><mu1>0.5</mu1><mu2>0.5</mu2></gazebo>";
  const double angle = std::atan(0.5);
  for (const double heading : {0.0, 0.9, 2.3}) {
    CAPTURE(heading);
    for (const double lean : {angle - 0.01, angle + 0.01, angle + 0.2}) {
      CAPTURE(lean);
      const Model m = bare("<box size=\"0.4 0.4 0.06\"/>", tags);
      const auto engine = make_engine("eigen", m, ground(lean, heading));
      VehicleState state = blank(0);
      engine->set_state(state);  // the lower face is at z = 0
      fly(*engine, 500);
      const Vector3d v = state_of(*engine).linear_velocity;
      fly(*engine, 500);
      const Vector3d way(std::cos(heading), std::sin(heading), 0);
      const Vector3d gained = (state_of(*engine).linear_velocity - v) / 0.5;
      const double slides = g * std::max(0.0, std::sin(lean) - 0.5 * std::cos(lean));
      CHECK(gained.dot(way) == doctest::Approx(slides).epsilon(1e-4));
      CHECK((gained - gained.dot(way) * way).norm() < 1e-4);
    }
  }
}

TEST_CASE("friction along the first direction is mu1, across it mu2") {
  const std::string tags =
      "<gazebo reference=\"frame\"><mu1>0.3</mu1><mu2>0.1</mu2><fdir1>1 1 0</fdir1></gazebo>";
  const auto engine = make_engine("eigen", bare("<box size=\"0.6 0.6 0.06\"/>", tags), ground());
  for (const auto& [heading, mu] : {std::pair(0.25, 0.3), std::pair(0.75, 0.1)}) {
    VehicleState state = blank(0);
    state.linear_velocity = {3 * std::cos(heading * M_PI), 3 * std::sin(heading * M_PI), 0};
    engine->set_state(state);
    fly(*engine, 300);
    const double before = state_of(*engine).linear_velocity.norm();
    fly(*engine, 200);
    CHECK((before - state_of(*engine).linear_velocity.norm()) / 0.2 ==
          doctest::Approx(mu * g).epsilon(1e-3));
  }
}

TEST_CASE("a ball that rolls is slowed by a hundredth of its radius off its centre") {
  // Radius 0.1 m, 2 kg, 0.01 kg m^2: with the torque c m g r, rolling.
  const Model m =
      model(shaped("ball", shape("<sphere radius=\"0.1\"/>"), inertial("2", round_body)));
  const auto engine = make_engine("eigen", m, ground());
  VehicleState state = blank(0);
  state.position.z() = 0.1;
  state.linear_velocity = {3, 0, 0};
  state.angular_velocity = {0, 30, 0};
  engine->set_state(state);
  fly(*engine, 500);
  const VehicleState before = state_of(*engine);
  fly(*engine, 500);
  const double slowed = (before.linear_velocity.x() - state_of(*engine).linear_velocity.x()) / 0.5;
  CHECK(slowed == doctest::Approx(0.01 * g / (1 + 0.01 / (2 * 0.01))).epsilon(1e-2));
}

TEST_CASE("a propeller that lies on the ground is braked by friction at its rim") {
  // Upside down: the disc of radius 0.1 and moment 2e-5 carries the whole weight.
  const Model m = model(link("frame", 1, skew_body, "xyz=\"0 0 -0.05\"") +
                        shaped("rotor", shape("<cylinder radius=\"0.1\" length=\"0.02\"/>"),
                               inertial("0.01", round_rotor)) +
                        joint("turn", "continuous", "frame", "rotor"));
  const auto engine = make_engine("eigen", m, ground());
  VehicleState state = blank(1);
  state.orientation = Quaterniond(0, 1, 0, 0);
  state.position.z() = 0.01;
  engine->set_state(state);
  fly(*engine, 1000);
  state = state_of(*engine);
  state.rotor_velocity[0] = 2000;
  engine->set_state(state);
  fly(*engine, 20);
  const double slowed = 2000 - state_of(*engine).rotor_velocity[0];
  CHECK(slowed == doctest::Approx(0.02 * 1.01 * g * 0.1 / 2e-5).epsilon(1e-2));
  CHECK(std::abs(state_of(*engine).angular_velocity.z()) < 1e-3);  // nothing holds on to it
  fly(*engine, 1000);
  CHECK(std::abs(state_of(*engine).rotor_velocity[0]) < 1e-3);
}
