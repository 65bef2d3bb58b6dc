#include "lqr.hpp"

#include <algorithm>
#include <cmath>

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

Lqr::Lqr(const ModelledVehicle& model, const Gains& g)
    : model_(model), switches_{g.feed_forward, g.flat_rates, g.integral, g.drag, g.gyroscopic} {
  Eigen::Matrix<double, 5, 1> factors, weights;
  factors << 1, 1, model.gravity, 1, 0;  // gravity times the tilt accelerates the vehicle
  weights << g.q_integral, g.q_position, g.q_velocity, g.q_tilt, g.q_rate;
  const auto level = chain<5>(factors, weights, g.r_tilt, g.integral);
  const auto height = chain<3>(Vector3d(1, 1, 0), {g.q_height_integral, g.q_height, g.q_climb},
                               g.r_thrust, g.integral);
  // Yaw has no integral.
  const Eigen::RowVectorXd yaw =
      optimal_gain((Eigen::Matrix2d() << 0, 1, 0, 0).finished(), Eigen::Vector2d(0, 1),
                   Eigen::Vector2d(g.q_yaw, g.q_yaw_rate), g.r_yaw);
  std::copy_n(level.data(), 5, numbers_.level);
  std::copy_n(height.data(), 3, numbers_.height);
  std::copy_n(yaw.data(), 2, numbers_.yaw);
  numbers_.sum_limit = g.sum_limit;
  numbers_.vehicle = numbers_of(model);
}

WrenchController::Feeds Lqr::feeds() const {
  return switches_.drag ? Feeds::flat_state_with_drag : Feeds::flat_state;
}

Demand Lqr::demand(const ControllerInput& input, double* memory) const {
  if (switches_.feed_forward) return follow(input, memory);
  Reference unmoved = input.wanted;
  unmoved.acceleration.setZero();
  unmoved.jerk.setZero();
  unmoved.snap.setZero();
  const FlatState level = flat_state(unmoved, model_, switches_.drag);
  FlatState flat = input.flat ? *input.flat : flat_state(input.wanted, model_, switches_.drag);
  flat.R_WF = level.R_WF;
  flat.thrust = level.thrust;
  ControllerInput levelled = input;
  levelled.flat = &flat;
  return follow(levelled, memory);
}

Demand Lqr::follow(const ControllerInput& input, double* memory) const {
  return call_with_numbers(input, feeds(), model_, [&](const InputNumbers<double>& numbers) {
    return demand_optimally(switches_, numbers_, numbers, memory_of<LqrMemory>(memory));
  });
}

std::shared_ptr<const LaneWrenchController> Lqr::in_lanes(double /*period*/) const {
  if (!switches_.feed_forward) return nullptr;
  return std::make_shared<LaneWrenchController>(
      LaneWrenchController{ControllerKind::lqr, switches_, list_numbers(numbers_)});
}

}  // namespace quadcore::control
