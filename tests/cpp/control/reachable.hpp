#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "quadcore/control/modelled_vehicle.hpp"

/// \file
/// What rotors can exert, found without an allocation.

namespace quadcore::test {

using control::ModelledVehicle;

/// Largest c . x under A x <= b with a unique solution, by trying every corner. NaN: there is none.
inline double largest(const Eigen::MatrixXd& A, const VectorXd& b, const VectorXd& c) {
  const Eigen::Index n = A.cols(), m = A.rows();
  const double slack = 1e-9 * (1 + b.cwiseAbs().maxCoeff());
  double best = NAN;
  std::vector<Eigen::Index> choose_gains(static_cast<std::size_t>(n));
  const std::function<void(std::size_t, Eigen::Index)> choose = [&](std::size_t depth,
                                                                    Eigen::Index from) {
    if (depth < choose_gains.size()) {
      for (Eigen::Index i = from; i < m; ++i) {
        choose_gains[depth] = i;
        choose(depth + 1, i + 1);
      }
      return;
    }
    Eigen::MatrixXd corner(n, n);
    VectorXd at(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      corner.row(i) = A.row(choose_gains[static_cast<std::size_t>(i)]);
      at[i] = b[choose_gains[static_cast<std::size_t>(i)]];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> solver(corner);
    if (!solver.isInvertible()) return;
    const VectorXd x = solver.solve(at);
    if ((A * x - b).maxCoeff() <= slack && !(c.dot(x) <= best)) best = c.dot(x);
  };
  choose(0, 0);
  return best;
}

/// What speeds of all kinds can do for a demand, by linear programs over the squares' freedom.
struct Reachable {
  Eigen::MatrixXd inverse, freedom;
  double most;

  Reachable(const ModelledVehicle& model, double fastest) : most(fastest * fastest) {
    const Eigen::MatrixXd B = model.effectiveness.bottomRows<4>();
    inverse = B.transpose() * (B * B.transpose()).inverse() / most;
    if (B.cols() > 4) {
      freedom = Eigen::FullPivLU<Eigen::MatrixXd>(B).kernel();
      freedom.colwise().normalize();
    }
  }

  /// Largest x <= 1 for which base + x direction can be exerted.
  double along(const Eigen::Vector4d& base, const Eigen::Vector4d& direction,
               double up_to = 1e3) const {
    return over(base, {direction}, up_to);
  }
  /// The same, another direction being of any size.
  double over(const Eigen::Vector4d& base, const std::vector<Eigen::Vector4d>& directions,
              double up_to) const {
    const auto n = inverse.rows(), d = static_cast<Eigen::Index>(directions.size());
    const auto k = freedom.cols();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n + 1, d + k);
    VectorXd b(2 * n + 1), c = VectorXd::Unit(d + k, 0);
    for (Eigen::Index i = 0; i < d; ++i) {
      A.col(i).head(n) = inverse * directions[static_cast<std::size_t>(i)];
    }
    if (k > 0) A.topRightCorner(2 * n + 1, k).topRows(n) = freedom;
    A.middleRows(n, n) = -A.topRows(n);
    b.head(n) = VectorXd::Ones(n) - inverse * base;
    b.segment(n, n) = inverse * base;
    A(2 * n, 0) = 1;
    b[2 * n] = up_to;
    return largest(A, b, c);
  }
};

}  // namespace quadcore::test
