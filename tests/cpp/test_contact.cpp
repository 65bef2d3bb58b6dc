#include <algorithm>
#include <cmath>

#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

constexpr double dt = 1e-3, g = 9.8, mass = 2, radius = 0.1, moment = 0.01;

World ground() {
  World world;
  world.ground_plane = true;
  return world;
}

/// A ball whose centre is `depth` nearer to the ground than its radius.
struct Ball {
  std::unique_ptr<Engine> engine;
  VehicleState state;

  Ball(const std::string& name, double depth, const Vector3d& v, const Vector3d& w = {0, 0, 0},
       const std::string& tags = "")
      : engine(make_engine(name,
                           model("<link name=\"ball\"><inertial><mass value=\"2\"/><inertia "
                                 "ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" "
                                 "iyz=\"0\"/></inertial><collision><geometry><sphere "
                                 "radius=\"0.1\"/></geometry></collision></link>" +
                                 tags),
                           ground())) {
    state.position = {3, -4, radius - depth};
    state.linear_velocity = v;
    state.angular_velocity = w;
    engine->set_state(state);
  }
  void step() {
    engine->step(0, dt, NoForces());
    engine->get_state(state);
  }
};

const char* const engines_with_contact[] = {"gazebo11", "ode"};

/// Points that span a shape of 0.2 x 0.3 x 0.5, or of radius 0.2 and length 0.5, or of radius 0.2.
std::vector<Vector3d> hull(ShapeKind kind) {
  std::vector<Vector3d> points;
  constexpr int n = 200;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n, c = std::cos(a), s = std::sin(a);
    switch (kind) {
      case ShapeKind::box:
        points.push_back({i & 1 ? 0.1 : -0.1, i & 2 ? 0.15 : -0.15, i & 4 ? 0.25 : -0.25});
        break;
      case ShapeKind::cylinder:
        for (const double z : {-0.25, 0.25}) points.push_back({0.2 * c, 0.2 * s, z});
        break;
      default:
        for (int j = 0; j <= n; ++j) {
          const double z = std::cos(M_PI * j / n), ring = std::sin(M_PI * j / n);
          points.push_back(0.2 * Vector3d(ring * c, ring * s, z));
        }
    }
  }
  return points;
}

const std::pair<ShapeKind, const char*> shapes[] = {
    {ShapeKind::box, "<box size=\"0.2 0.3 0.5\"/>"},
    {ShapeKind::cylinder, "<cylinder radius=\"0.2\" length=\"0.5\"/>"},
    {ShapeKind::sphere, "<sphere radius=\"0.2\"/>"}};

}  // namespace

TEST_CASE("a ball in the ground is lifted out at once, but leaves it at 1 cm/s at most") {
  for (const char* name : engines_with_contact) {
    CAPTURE(name);
    for (const double depth : {5e-6, 1e-3}) {
      Ball ball(name, depth, {0, 0, -0.3});
      ball.step();
      // The ground gives way by the force over dt kp + kd (kp 5e11 N/m, kd 2 N s/m) in a step.
      const double force = mass * (0.3 + g * dt + depth / dt) / dt;
      const double give = dt * force / (dt * 5e11 + 2);
      CHECK(std::abs(ball.state.position.z() - (radius - give)) < 1e-11);
      CHECK(ball.state.linear_velocity.z() == doctest::Approx(std::min(depth / dt, 0.01)));
      CHECK((ball.state.position.head<2>() - Eigen::Vector2d(3, -4)).norm() < 1e-15);
      CHECK(ball.state.angular_velocity.isZero(0));
    }
  }
}

TEST_CASE("a ball that leaves the ground by itself is not held, nor one above it") {
  for (const char* name : engines_with_contact) {
    CAPTURE(name);
    Ball leaving(name, 1e-4, {0, 0, 2});
    leaving.step();
    CHECK(leaving.state.linear_velocity.z() == doctest::Approx(2 - g * dt));
    Ball above(name, -1e-9, {0.5, 0, -0.3});
    above.step();
    CHECK(above.state.linear_velocity.z() == doctest::Approx(-0.3 - g * dt));
    CHECK(above.state.linear_velocity.x() == 0.5);
  }
}

TEST_CASE("a slow ball sticks and rolls, a fast one slides with friction 1") {
  for (const char* name : engines_with_contact) {
    CAPTURE(name);
    const double normal_impulse = mass * (0.01 + 0.3 + g * dt);
    for (const double sign : {1.0, -1.0}) {
      for (const int along : {0, 1}) {
        CAPTURE(along);
        const Vector3d way = sign * Vector3d::Unit(along);
        // Of the ball's weight against the ground; a torque about up x way rolls it forward.
        const Vector3d roll = Vector3d::UnitZ().cross(way);
        Ball slow(name, 1e-3, 0.2 * way - 0.3 * Vector3d::UnitZ());
        slow.step();
        const double grip = 0.2 / (1 / mass + radius * radius / moment);
        CHECK(slow.state.linear_velocity.dot(way) == doctest::Approx(0.2 - grip / mass));
        CHECK(slow.state.angular_velocity.dot(roll) == doctest::Approx(radius * grip / moment));
        CHECK((slow.state.position - Vector3d(3, -4, radius)).dot(way) ==
              doctest::Approx(dt * (0.2 - grip / mass)).epsilon(1e-6));

        Ball fast(name, 1e-3, 8 * way - 0.3 * Vector3d::UnitZ());
        fast.step();
        CHECK(fast.state.linear_velocity.dot(way) ==
              doctest::Approx(8 - normal_impulse / mass).epsilon(1e-3));
        CHECK(fast.state.angular_velocity.dot(roll) ==
              doctest::Approx(radius * normal_impulse / moment).epsilon(1e-2));
      }
    }
    // Spin about the vertical meets no friction at a point.
    Ball spinning(name, 1e-3, {0, 0, -0.3}, {0, 0, 5});
    spinning.step();
    CHECK((spinning.state.angular_velocity - Vector3d(0, 0, 5)).norm() < 1e-9);
  }
}

TEST_CASE("a direction of friction that stands upright is none") {
  for (const char* name : engines_with_contact) {
    CAPTURE(name);
    std::vector<VehicleState> after;
    for (const char* tag : {"", "<fdir1>0 0 3</fdir1>"}) {
      Ball sliding(name, 1e-3, {0, -8, -0.3}, {0, 0, 0},
                   std::string("<gazebo reference=\"ball\">") + tag + "</gazebo>");
      sliding.step();
      after.push_back(sliding.state);
    }
    CHECK(after[1].linear_velocity == after[0].linear_velocity);
    CHECK(after[1].linear_velocity.y() > -8);
    CHECK(after[1].angular_velocity == after[0].angular_velocity);
  }
}

TEST_CASE("each shape touches the ground with its lowest point, wherever it sits in a link") {
  const Pose in_link{{0.07, -0.11, 0.13}, {0.4, -0.7, 1.1}};
  const std::string origin = "<origin xyz=\"0.07 -0.11 0.13\" rpy=\"0.4 -0.7 1.1\"/>";
  for (const auto& [kind, shape] : shapes) {
    for (const bool on_rotor : {false, true}) {
      CAPTURE(shape);
      CAPTURE(on_rotor);
      const std::string collision =
          "<collision>" + origin + "<geometry>" + shape + "</geometry></collision>";
      const auto with = [&](std::string text, bool here) {
        if (here) text.insert(text.find("</link>"), collision);
        return text;
      };
      const Model m =
          model(with(link("frame", 1, skew_body, "xyz=\"0.02 -0.03 0.05\" rpy=\"0.1 0.2 0.3\""),
                     !on_rotor) +
                with(link("rotor", 0.1, round_rotor, "xyz=\"0 0 0.04\""), on_rotor) +
                joint("turn", "continuous", "frame", "rotor",
                      "xyz=\"0.3 -0.2 0.1\" rpy=\"0.5 -0.3 0.2\""));
      const std::vector<Vector3d> points = hull(kind);
      for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        VehicleState state;
        state.orientation = quaternion_from_rpy({0.9 * i, 0.5 - 0.4 * i, 2.0 - i});
        state.rotor_velocity = VectorXd::Zero(1);
        state.rotor_angle = VectorXd::Constant(1, 0.7 * i - 1);
        Eigen::Isometry3d X_WS(state.orientation);
        if (on_rotor) {
          X_WS = X_WS * Eigen::Translation3d(0.3, -0.2, 0.1) *
                 quaternion_from_rpy({0.5, -0.3, 0.2}) *
                 Eigen::AngleAxisd(state.rotor_angle[0], Vector3d::UnitZ());
        }
        X_WS = X_WS * Eigen::Translation3d(in_link.xyz) * in_link.rotation();
        double lowest = INFINITY;
        for (const Vector3d& p : points) lowest = std::min(lowest, (X_WS * p).z());

        constexpr double near = 1e-3;  // to what the points are close
        for (const EngineInfo& info : engines()) {
          CAPTURE(info.name);
          const auto engine = make_engine(info.name, m, ground());
          state.position.z() = near - lowest;
          engine->set_state(state);
          engine->step(0, dt, NoForces());
          CHECK(engine->kinematics().v_WCcm_F.norm() == doctest::Approx(g * dt));
          const bool soft = info.name == "eigen";  // which does not begin much deeper than it rests
          state.position.z() = -(soft ? near / 10 : near) - lowest;
          engine->set_state(state);
          engine->step(0, dt, NoForces());
          const double v = engine->kinematics().v_WCcm_F.norm();
          if (soft) {
            CHECK(v != doctest::Approx(g * dt).epsilon(1e-9));
          } else {
            CHECK(v != doctest::Approx(g * dt));
          }
        }
      }
    }
  }
}
