#include "lqr.hpp"

#include <cmath>

#include "quadcore/control/flat_state.hpp"
#include "riccati.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

/// Return the gains of a chain of integrators. Each is the derivative of the one before times a
/// factor, and the control drives the last. Without an integral, the first gain is zero.
template <int n>
Eigen::Matrix<double, 1, n> chain(const Eigen::Matrix<double, n, 1>& factors,
                                  const Eigen::Matrix<double, n, 1>& weights, double r,
                                  bool integral) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i + 1 < n; ++i) A(i, i + 1) = factors[i];
  const Eigen::VectorXd b = Eigen::VectorXd::Unit(n, n - 1);
  const int from = integral ? 0 : 1, used = n - from;
  Eigen::Matrix<double, 1, n> gains = Eigen::Matrix<double, 1, n>::Zero();
  gains.tail(used) =
      optimal_gain(A.bottomRightCorner(used, used), b.tail(used), weights.tail(used), r);
  return gains;
}

T weight(const char* name, const char* unit, const char* fallback, const char* of) {
  return T::number(name, unit, fallback, std::string("weight of the squared ") + of).above(0);
}

}  // namespace

const Settings<Lqr::Gains>& Lqr::settings() {
  using G = Gains;
  static const Settings<G> all = {
      {weight("q_integral", "1/(m s)^2", "200", "integral of the horizontal position error"),
       &G::q_integral},
      {weight("q_position", "1/m^2", "400", "position error along x and y"), &G::q_position},
      {weight("q_velocity", "s^2/m^2", "20", "velocity error along x and y"), &G::q_velocity},
      {weight("q_tilt", "1/rad^2", "200", "roll and pitch errors"), &G::q_tilt},
      {weight("q_rate", "s^2/rad^2", "1", "roll and pitch rate errors"), &G::q_rate},
      {weight("r_tilt", "s^4/rad^2", "0.01", "angular acceleration about x and y"), &G::r_tilt},
      {weight("q_height_integral", "1/(m s)^2", "144", "integral of the height error"),
       &G::q_height_integral},
      {weight("q_height", "1/m^2", "256", "height error"), &G::q_height},
      {weight("q_climb", "s^2/m^2", "16", "vertical velocity error"), &G::q_climb},
      {weight("r_thrust", "s^4/m^2", "1", "acceleration by the thrust"), &G::r_thrust},
      {weight("q_yaw", "1/rad^2", "9", "yaw error"), &G::q_yaw},
      {weight("q_yaw_rate", "s^2/rad^2", "3", "yaw rate error"), &G::q_yaw_rate},
      {weight("r_yaw", "s^4/rad^2", "1", "angular acceleration about z"), &G::r_yaw},
      {T::number("sum_limit", "m s", "0.5", "maximum integral along an axis").at_least(0),
       &G::sum_limit},
      {T::flag("integral", "true", "integrates the position error"), &G::integral},
      {T::flag("feed_forward", "true", "feeds the reference's acceleration forward"),
       &G::feed_forward},
      {T::flag("drag", "true", "compensates the modelled aerodynamic force and torque"), &G::drag},
      {T::flag("gyroscopic", "true", "compensates the rotors' gyroscopic torque"), &G::gyroscopic},
      {T::flag("flat_rates", "true",
               "feeds the reference's angular velocity and acceleration forward"),
       &G::flat_rates},
  };
  return all;
}

Lqr::Lqr(const ModelledVehicle& model, const Gains& g) : model_(model), gains_(g) {
  Eigen::Matrix<double, 5, 1> factors, weights;
  factors << 1, 1, model.gravity, 1, 0;  // gravity times the tilt accelerates the vehicle
  weights << g.q_integral, g.q_position, g.q_velocity, g.q_tilt, g.q_rate;
  level_ = chain<5>(factors, weights, g.r_tilt, g.integral);
  height_ = chain<3>(Vector3d(1, 1, 0), {g.q_height_integral, g.q_height, g.q_climb}, g.r_thrust,
                     g.integral);
  // Yaw has no integral.
  const Eigen::RowVectorXd yaw =
      optimal_gain((Eigen::Matrix2d() << 0, 1, 0, 0).finished(), Eigen::Vector2d(0, 1),
                   Eigen::Vector2d(g.q_yaw, g.q_yaw_rate), g.r_yaw);
  yaw_ = yaw;
}

Demand Lqr::demand(const LawInput& input, double* memory) const {
  const Odometry& now = input.now;
  const Reference& wanted = input.wanted;
  FlatState flat = input.flat ? *input.flat : flat_state(wanted, model_, gains_.drag);
  if (!gains_.feed_forward) {
    Reference unmoved = wanted;
    unmoved.acceleration.setZero();
    unmoved.jerk.setZero();
    unmoved.snap.setZero();
    const FlatState level = flat_state(unmoved, model_, gains_.drag);
    flat.R_WF = level.R_WF;
    flat.thrust = level.thrust;
  }

  const Vector3d error_W = wanted.position - now.position;
  Eigen::Map<Vector3d> integral(memory);
  for (int i = 0; i < 3; ++i) {
    const double sum = integral[i] + input.period * error_W[i];
    const bool grows = std::abs(sum) > std::abs(integral[i]);
    const bool fits = std::abs(sum) <= gains_.sum_limit && !input.saturated;
    if (!grows || fits) integral[i] = sum;
  }
  // In the axes D of the flat state, around which the vehicle is linearised.
  const Matrix3d R_DW = flat.R_WF.transpose();
  const Vector3d sum_D = R_DW * integral, error_D = R_DW * error_W,
                 slip_D = R_DW * (wanted.velocity - now.linear_velocity);
  const Matrix3d R_FD = now.orientation.conjugate().toRotationMatrix() * flat.R_WF;
  const Quaterniond q_FD(R_FD);
  const Vector3d turn_F = (q_FD.w() < 0 ? -2 : 2) * q_FD.vec();
  const Vector3d wanted_w_F = (gains_.flat_rates ? 1 : 0) * (R_FD * flat.w_WF_F);
  const Vector3d slip_w_F = wanted_w_F - now.angular_velocity;

  const auto level = [&](double sum, double error, double slip, double tilt, double rate) {
    return level_[0] * sum + level_[1] * error + level_[2] * slip + level_[3] * tilt +
           level_[4] * rate;
  };
  // Positive pitch accelerates along x, positive roll along -y.
  Vector3d dw_F(-level(sum_D.y(), error_D.y(), slip_D.y(), -turn_F.x(), -slip_w_F.x()),
                level(sum_D.x(), error_D.x(), slip_D.x(), turn_F.y(), slip_w_F.y()),
                yaw_[0] * turn_F.z() + yaw_[1] * slip_w_F.z());
  if (gains_.flat_rates) dw_F += R_FD * flat.dw_WF_F - now.angular_velocity.cross(wanted_w_F);
  const double climb = height_.dot(Eigen::RowVector3d(sum_D.z(), error_D.z(), slip_D.z()));

  Vector3d tau_air_F = Vector3d::Zero();
  if (gains_.drag) {
    tau_air_F = model_.air_torque_F(now.orientation.conjugate() * now.linear_velocity,
                                    now.angular_velocity);
  }
  const Vector3d h_F = gains_.gyroscopic ? input.h_F : Vector3d(Vector3d::Zero());
  return {flat.thrust + model_.mass * climb,
          torque_for(model_, dw_F, now.angular_velocity, h_F, tau_air_F)};
}

}  // namespace quadcore::control
