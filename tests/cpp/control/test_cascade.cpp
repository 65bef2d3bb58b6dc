#include <cmath>

#include "euler_formulas.hpp"
#include "modelled_vehicles.hpp"
#include "numbers.hpp"
#include "quadcore/control/wrench_controller.hpp"
#include "quadcore/plugin/random.hpp"

using namespace quadcore;
using namespace quadcore::control;

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
    for (int k = 0; k < 3; ++k) turn[k] = std::atan2(std::sin(turn[k]), std::cos(turn[k]));
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

TEST_CASE("on its reference the compensated cascade demands the flat state's thrust and torque") {
  ModelledVehicle model = test::odd_belief(4);
  model.p_FCcm_F.setZero();  // flat states are exact only for this
  const ControllerInfo& info = find_controller("pd_compensated");
  const auto controller = info.make(model, complete(info.defaults, {}));
  for (int i = 0; i < 50; ++i) {
    double count = 100 * i;
    const auto random = [&](double size) -> Vector3d {
      return size *
             Vector3d(random_normal(8, count), random_normal(8, count), random_normal(8, count));
    };
    Reference wanted;
    wanted.position = random(5);
    wanted.velocity = random(3);
    wanted.acceleration = random(2);
    wanted.jerk = random(2);
    wanted.snap = random(2);
    wanted.yaw = random(3).x();
    wanted.yaw_rate = random(1).x();
    wanted.yaw_acceleration = random(1).x();
    const FlatState flat = flat_state(wanted, model, true);
    Odometry now;
    now.position = wanted.position;
    now.orientation = Quaterniond(flat.R_WF);
    now.linear_velocity = wanted.velocity;
    now.angular_velocity = flat.w_WF_F;
    std::vector<double> memory(info.memory_size);
    const Demand demand = controller->demand(
        {0.002, true, now, wanted, &flat, {}, Vector3d::Zero(), false}, memory.data());
    CHECK(demand.thrust == doctest::Approx(flat.thrust));
    const Vector3d torque =
        torque_for(model, flat.dw_WF_F, flat.w_WF_F, Vector3d::Zero(), Vector3d::Zero());
    CHECK((demand.torque_F - torque).norm() < 1e-12 * (1 + torque.norm()));
  }
}
