#include "riccati.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::control {

Eigen::RowVectorXd optimal_gain(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                const Eigen::VectorXd& weights, double r) {
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd Z(2 * n, 2 * n);
  Z << A, -b * b.transpose() / r, -Eigen::MatrixXd(weights.asDiagonal()), -A.transpose();
  double change = 1;
  for (int round = 0; change > 1e-13 && round < 100; ++round) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Z);
    // Scaling by the determinant makes a few iterations sufficient (Byers, Linear Algebra Appl.
    // 1987).
    const double size = std::abs(lu.determinant());
    const double scale = elementary::exp(-elementary::log(size) / static_cast<double>(2 * n));
    const Eigen::MatrixXd next = (scale * Z + lu.inverse() / scale) / 2;
    change = (next - Z).norm() / next.norm();
    Z = next;
  }
  if (!(change <= 1e-9))
    throw InputError(
        "controller 'lqr': these weights give no stabilising gain. Use other weights.");
  Eigen::MatrixXd left(2 * n, n), right(2 * n, n);
  left << Z.topRightCorner(n, n), Z.bottomRightCorner(n, n) + one;
  right << Z.topLeftCorner(n, n) + one, Z.bottomLeftCorner(n, n);
  const Eigen::MatrixXd P = left.colPivHouseholderQr().solve(-right);
  return b.transpose() * P / r;
}

}  // namespace quadcore::control
