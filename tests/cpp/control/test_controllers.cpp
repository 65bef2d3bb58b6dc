#include <cmath>
#include <set>
#include <string>

#include "modelled_vehicles.hpp"
#include "quadcore/control/controller.hpp"
#include "riccati.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

/// A rigid body on which a controller's demand acts at once.
struct Ideal {
  ModelledVehicle model = test::odd_belief(4);
  std::unique_ptr<WrenchController> controller;
  std::vector<double> memory;
  Odometry now;
  double period = 1e-3;
  bool begins = true;

  Ideal(const std::string& name, const Values& given) {
    const ControllerInfo& info = find_controller(name);
    controller = info.make(model, complete(given, info.defaults));
    memory.assign(info.memory_size, 0.0);
  }

  /// Newton and Euler, by Heun's method; the demand is held.
  void step(const Reference& wanted) {
    const Demand demand = controller->demand(
        {period, begins, now, wanted, nullptr, last, Vector3d::Zero(), false}, memory.data());
    begins = false;
    last = demand;
    const auto acceleration = [&](const Odometry& o) -> Vector3d {
      return demand.thrust / model.mass * (o.orientation * Vector3d::UnitZ()) -
             Vector3d(0, 0, model.gravity);
    };
    const auto turning = [&](const Odometry& o) -> Vector3d {
      const Matrix3d& I = model.inertia_Ccm_F;
      return I.inverse() * (demand.torque_F - o.angular_velocity.cross(I * o.angular_velocity));
    };
    const auto turned = [](const Quaterniond& q, const Vector3d& turn) {
      return (q * Quaterniond(Eigen::AngleAxisd(turn.norm() + 1e-300, turn.normalized())))
          .normalized();
    };
    Odometry half = now;
    half.linear_velocity += period / 2 * acceleration(now);
    half.angular_velocity += period / 2 * turning(now);
    half.orientation =
        turned(now.orientation, period / 4 * (now.angular_velocity + half.angular_velocity));
    now.position += period * half.linear_velocity;
    now.orientation = turned(now.orientation, period * half.angular_velocity);
    now.linear_velocity += period * acceleration(half);
    now.angular_velocity += period * turning(half);
  }

  Demand last;
};

/// Solution of e'' + d e' + p e = 0 from (1, 0).
double decay(double p, double d, double t) {
  const double inner = d * d / 4 - p;
  const double r = std::sqrt(std::abs(inner));
  const double wave = inner > 0 ? std::cosh(r * t) + d / 2 / r * std::sinh(r * t)
                                : std::cos(r * t) + d / 2 / r * std::sin(r * t);
  return std::exp(-d / 2 * t) * wave;
}

Reference at_rest() {
  Reference wanted;
  wanted.position = {1, 2, 3};
  return wanted;
}

}  // namespace

TEST_CASE("height and yaw of the cascade have the poles of its gains") {
  Ideal ideal("pd", {});
  const Reference wanted = at_rest();
  ideal.now.position = wanted.position - Vector3d(0, 0, 0.01);
  ideal.now.orientation = quaternion_from_rpy({0, 0, -0.01});
  for (int i = 1; i <= 1500; ++i) {
    ideal.step(wanted);
    if (i % 500 != 0) continue;
    const double t = 1e-3 * i;
    const double height = (wanted.position - ideal.now.position).z() / 0.01;
    CHECK(height == doctest::Approx(decay(2.4, 11.25, t)).epsilon(0.01));
    const double yaw = -rpy_from_quaternion(ideal.now.orientation).z() / 0.01;
    CHECK(yaw == doctest::Approx(decay(2, 3, t)).epsilon(0.01));
  }
}

TEST_CASE("roll and pitch of the cascade have the poles of its gains, at any yaw and rate") {
  for (const double yaw : {0.0, 1.2, -2.5}) {
    Ideal ideal("pd", {{"kp_xy", 0}, {"kd_xy", 0}});
    Reference wanted = at_rest();
    wanted.yaw = yaw;
    ideal.now.position = wanted.position;
    ideal.now.orientation = quaternion_from_rpy({0.3, -0.2, yaw});
    for (int i = 1; i <= 300; ++i) ideal.step(wanted);
    const Vector3d rpy = rpy_from_quaternion(ideal.now.orientation);
    CHECK(rpy.x() == doctest::Approx(0.3 * decay(96, 16, 0.3)).scale(0.3).epsilon(0.01));
    CHECK(rpy.y() == doctest::Approx(-0.2 * decay(96, 16, 0.3)).scale(0.2).epsilon(0.01));
  }
}

TEST_CASE("every controller brings an odd vehicle that the rotors obey at once to its place") {
  for (const ControllerInfo& info : list_controllers()) {
    // The gains of the firmwares suit their own vehicles.
    if (std::set<std::string>{"pid_thesis", "crazyflie_pid", "mellinger", "px4"}.count(info.name)) {
      continue;
    }
    CAPTURE(info.name);
    Ideal ideal(info.name, {});
    Reference wanted = at_rest();
    wanted.yaw = 0.8;
    ideal.now.position = wanted.position + Vector3d(0.3, -0.2, 0.1);
    ideal.now.orientation = quaternion_from_rpy({0.1, 0.2, 0.5});
    for (int i = 0; i < 40000; ++i) ideal.step(wanted);
    CHECK((ideal.now.position - wanted.position).norm() < 2e-3);
    CHECK(rpy_from_quaternion(ideal.now.orientation).z() == doctest::Approx(0.8).epsilon(1e-3));
  }
}

TEST_CASE("the printed gains of section 6.2 are unstable in x and y, by Routh and Hurwitz") {
  // s^3 + Kd s^2 + Kp s + Ki is stable only if Kd Kp > Ki.
  const auto gain = [](const std::string& controller, const std::string& name) {
    for (const TagSpec& spec : Controller::table(controller)) {
      if (spec.name == name) return default_of(spec);
    }
    return std::nan("");
  };
  const auto margin = [&](const std::string& name) {
    return gain(name, "kd_xy") * gain(name, "kp_xy") - gain(name, "ki_xy");
  };
  CHECK(margin("pid_thesis") == doctest::Approx(-0.5));
  CHECK(margin("pid") > 0);
}

TEST_CASE("from upside down the quaternion error brings a vehicle back") {
  Ideal ideal("geometric", {});
  const Reference wanted = at_rest();
  ideal.now.position = wanted.position;
  ideal.now.orientation = quaternion_from_rpy({M_PI, 0, 0});
  for (int i = 0; i < 6000; ++i) ideal.step(wanted);
  CHECK((ideal.now.position - wanted.position).norm() < 0.05);
}

TEST_CASE("an optimal gain solves the Riccati equation and is stable") {
  Eigen::MatrixXd A(3, 3);
  A << 0, 1, 0, 0, 0, 9.8, 0.3, 0, -0.2;
  const Vector3d b(0, 0.1, 1), weights(4, 2, 1);
  const double r = 0.3;
  const Eigen::RowVectorXd K = optimal_gain(A, b, weights, r);
  // Of all gains near it none is cheaper, by the cost that a Lyapunov equation gives.
  const auto cost = [&](const Eigen::RowVectorXd& gain) {
    const Eigen::MatrixXd closed = A - b * gain;
    const Eigen::MatrixXd Q = Eigen::MatrixXd(weights.asDiagonal()) + r * gain.transpose() * gain;
    Eigen::MatrixXd lyapunov = Eigen::MatrixXd::Zero(9, 9);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
          lyapunov(3 * j + i, 3 * j + k) += closed(k, i);
          lyapunov(3 * j + i, 3 * k + i) += closed(k, j);
        }
      }
    }
    const Eigen::VectorXd p =
        lyapunov.fullPivLu().solve(-Eigen::Map<const Eigen::VectorXd>(Q.data(), 9));
    return Eigen::Map<const Matrix3d>(p.data()).trace();
  };
  const double best = cost(K);
  CHECK(best > 0);
  for (int i = 0; i < 3; ++i) {
    for (const double change : {-0.02, 0.02}) {
      Eigen::RowVectorXd other = K;
      other[i] *= 1 + change;
      CHECK(cost(other) > best);
    }
  }
}

TEST_CASE("an unknown controller is refused with what to write instead") {
  CHECK(test::contains(test::refusal([] { find_controller("geometrical"); }),
                       "controller 'geometrical' does not exist. Did you mean 'geometric'?"));
}
