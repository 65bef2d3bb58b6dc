#include <cmath>
#include <set>
#include <string>

#include "euler_formulas.hpp"
#include "modelled_vehicles.hpp"
#include "numbers.hpp"
#include "quadcore/control/controller.hpp"
#include "quadcore/plugin/random.hpp"
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

TEST_CASE("the torques of the cascade are those of Lagrange's equation (2.50) at any attitude") {
  const ModelledVehicle model = test::odd_belief(4);
  const ControllerInfo& info = find_controller("pid");
  const auto controller = info.make(model, complete(info.defaults, {}));
  const auto W_at = [](const Vector3d& eta) {  // (2.9)
    Matrix3d W;
    W << 1, 0, -std::sin(eta.y()),                                    //
        0, std::cos(eta.x()), std::sin(eta.x()) * std::cos(eta.y()),  //
        0, -std::sin(eta.x()), std::cos(eta.x()) * std::cos(eta.y());
    return W;
  };
  const auto J_at = [&](const Vector3d& eta) -> Matrix3d {
    return W_at(eta).transpose() * model.inertia_Ccm_F * W_at(eta);
  };
  for (int i = 0; i < 200; ++i) {
    double count = 100 * i;
    const auto random = [&](double x, double y, double z) -> Vector3d {
      const auto uniform = [&] { return std::erf(random_normal(7, count) / std::sqrt(2)); };
      return {x * uniform(), y * uniform(), z * uniform()};
    };
    const Vector3d eta = random(M_PI, 1.5, M_PI), rates = random(2, 2, 2);
    Odometry now;
    now.position = random(5, 5, 5);
    now.orientation = quaternion_from_rpy(eta);
    now.linear_velocity = random(3, 3, 3);
    now.angular_velocity = W_at(eta) * rates;
    Reference wanted;
    wanted.position = random(5, 5, 5);
    wanted.velocity = random(3, 3, 3);
    wanted.acceleration = random(3, 3, 3);
    wanted.yaw = random(8, 0, 0).x();
    wanted.yaw_rate = random(2, 0, 0).x();
    const Vector3d sum = random(2, 2, 2), angle_sum = random(1, 1, 1);
    std::vector<double> memory(info.memory_size);
    Eigen::Map<Vector3d>(memory.data()) = sum;
    Eigen::Map<Vector3d>(memory.data() + 3) = angle_sum;
    const double period = 0.002;
    const Demand demand = controller->demand(
        {period, false, now, wanted, nullptr, {}, Vector3d::Zero(), false}, memory.data());

    // (2.43) with the integral, and the directions that (2.46) and (2.47) solve for.
    const Vector3d error = wanted.position - now.position;
    const Vector3d lift =
        Vector3d(2.4, 2.4, 2.4).cwiseProduct(error) + 0.8 * (sum + period * error) +
        Vector3d(2.5, 2.5, 11.25).cwiseProduct(wanted.velocity - now.linear_velocity) +
        wanted.acceleration + Vector3d(0, 0, model.gravity);
    CHECK(demand.thrust ==
          doctest::Approx(model.mass * lift.dot(now.orientation * Vector3d::UnitZ())));
    const Vector3d level = quaternion_from_rpy({0, 0, -eta.z()}) * lift;
    const Vector3d wanted_eta(std::asin(-level.y() / level.norm()),
                              std::atan2(level.x(), level.z()), wanted.yaw);
    const auto near_wanted = quaternion_from_rpy({wanted_eta.x(), wanted_eta.y(), eta.z()});
    CHECK((near_wanted * Vector3d::UnitZ()).isApprox(lift.normalized(), 1e-12));

    Vector3d turn = wanted_eta - eta;
    for (double& angle : turn) angle = std::atan2(std::sin(angle), std::cos(angle));
    const Vector3d y = Vector3d(96, 96, 2).cwiseProduct(turn) +
                       Vector3d(96, 96, 0).cwiseProduct(angle_sum + period * turn) +
                       Vector3d(16, 16, 3).cwiseProduct(Vector3d(0, 0, wanted.yaw_rate) - rates);
    // C(eta, eta') eta' = J' eta' - d(eta'^T J eta')/d(eta)/2, by differences.
    constexpr double h = 1e-5;
    Vector3d C_rates = (J_at(eta + h * rates) - J_at(eta - h * rates)) / (2 * h) * rates;
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = h * Vector3d::Unit(k);
      C_rates[k] -= rates.dot((J_at(eta + step) - J_at(eta - step)) * rates) / (4 * h);
    }
    const Vector3d generalised = W_at(eta).transpose() * demand.torque_F;
    CHECK((generalised - (J_at(eta) * y + C_rates)).norm() < 1e-8 * (1 + y.norm()));
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

TEST_CASE("rates of roll, pitch and yaw are those of the orientation") {
  const Vector3d rpy(0.3, -0.5, 1.1), rates(0.7, -0.4, 0.9), bend(0.2, 0.3, -0.6);
  constexpr double h = 1e-5;
  const auto rate_at = [&](double t) -> Vector3d {  // w_F by differences of the rotation
    const auto R = [&](double s) {
      return quaternion_from_rpy(rpy + s * rates + s * s / 2 * bend).toRotationMatrix();
    };
    const Matrix3d S = R(t).transpose() * (R(t + h) - R(t - h)) / (2 * h);
    return {S(2, 1), S(0, 2), S(1, 0)};
  };
  const Matrix3d R_WF = quaternion_from_rpy(rpy).toRotationMatrix();
  const EulerAngles<double> angles(numbers_of(R_WF));
  const Vec3<double> w_F = angles.by_W(numbers_of(rates));
  CHECK((vector_of(w_F) - rate_at(0)).norm() < 1e-8);
  const Vector3d turning = (rate_at(1e-3) - rate_at(-1e-3)) / 2e-3;
  const Vec3<double> dw_F = angles.by_W(numbers_of(bend)) + angles.by_dW(numbers_of(rates));
  CHECK((vector_of(dw_F) - turning).norm() < 1e-4);
  CHECK((vector_of(angles.by_inverse_W(w_F)) - rates).norm() < 1e-14);
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
