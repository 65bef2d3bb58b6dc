#include "quadcore/control/allocation.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

#include "quadcore/error.hpp"

namespace quadcore::control {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// More is no question of thrust, and the sums below stay finite.
constexpr double largest_square = 1e12;

}  // namespace

Allocation::Allocation(const Belief& belief) {
  const Eigen::Index n = belief.effectiveness.cols();
  effect_ = belief.effectiveness.bottomRows<4>();  // z, then the torques
  inverse_.resize(n, 4);
  // In units in which thrust and torques are of one size, so that the rank can be told.
  const Eigen::Vector4d size = effect_.rowwise().norm();
  const bool spans = n >= 4 && (size.array() > 0).all();
  if (spans) {
    const Eigen::Matrix4Xd scaled = size.cwiseInverse().asDiagonal() * effect_;
    const Eigen::Matrix4d squared = scaled * scaled.transpose();
    const Eigen::Vector4d singular = squared.jacobiSvd().singularValues();
    if (singular[3] > 1e-9 * singular[0]) {
      inverse_ = scaled.transpose() * squared.inverse() * size.cwiseInverse().asDiagonal();
      least_.resize(n);
      most_.resize(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const BelievedRotor& rotor = belief.rotors[static_cast<std::size_t>(i)];
        least_[i] = rotor.slowest * rotor.slowest;
        most_[i] = std::min(rotor.fastest * rotor.fastest, largest_square);
      }
      return;
    }
  }
  throw InputError(
      "the rotors do not exert thrust and torques about all axes independently of each other; add "
      "rotors or force laws, or give the spins that turn them against each other");
}

bool Allocation::allocate(const Demand& demand, double* squares) const {
  Eigen::Map<VectorXd> u(squares, inverse_.rows());
  // Columns, not a product with a matrix, whose order of summation would depend on where the
  // caller's numbers lie in memory.
  u = demand.torque_F.x() * inverse_.col(1) + demand.torque_F.y() * inverse_.col(2);
  u += demand.torque_F.z() * inverse_.col(3) + demand.thrust * inverse_.col(0);
  if ((u.array() >= least_.array()).all() && (u.array() <= most_.array()).all()) return true;

  u = demand.torque_F.x() * inverse_.col(1) + demand.torque_F.y() * inverse_.col(2);
  const Share share = fit(u, demand.thrust);
  u = share.roll_pitch * u + share.thrust * inverse_.col(0);
  double yaw = 1;  // share of it
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double change = inverse_(i, 3) * demand.torque_F.z();
    if (change == 0) continue;
    const double room = (change > 0 ? most_[i] : least_[i]) - u[i];
    yaw = std::clamp(room / change, 0.0, yaw);
  }
  u += yaw * demand.torque_F.z() * inverse_.col(3);
  u = u.cwiseMax(least_).cwiseMin(most_);  // last digits
  return false;
}

Allocation::Share Allocation::fit(const Eigen::Ref<const VectorXd>& of_torques,
                                  double thrust) const {
  // Rotor i: least <= s torque_i + T lift_i <= most bounds T from two sides by lines in s. The
  // largest s in [0, 1] is where a lower line meets an upper one.
  const auto line = [&](Eigen::Index i, bool upper) {  // T at s = 0 and its slope
    const double lift = inverse_(i, 0);
    const double limit = upper == (lift > 0) ? most_[i] : least_[i];
    return std::pair{limit / lift, -of_torques[i] / lift};
  };
  const Eigen::Index n = of_torques.size();
  double s = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (inverse_(i, 0) == 0) continue;
    const auto [low, low_slope] = line(i, false);
    for (Eigen::Index j = 0; j < n; ++j) {
      if (inverse_(j, 0) == 0) continue;
      const auto [high, high_slope] = line(j, true);
      if (low_slope > high_slope) {
        s = std::clamp((high - low) / (low_slope - high_slope), 0.0, s);
      }
    }
  }
  double least = -infinity, most = infinity;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (inverse_(i, 0) == 0) continue;
    const auto [low, low_slope] = line(i, false);
    const auto [high, high_slope] = line(i, true);
    least = std::max(least, low + s * low_slope);
    most = std::min(most, high + s * high_slope);
  }
  // At the last share the two bounds are one but for rounding.
  return {s, std::max(least, std::min(thrust, most))};
}

Demand Allocation::exerted(const double* squares) const {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (Eigen::Index i = 0; i < effect_.cols(); ++i) sum += squares[i] * effect_.col(i);
  return {sum[0], sum.tail<3>()};
}

}  // namespace quadcore::control
