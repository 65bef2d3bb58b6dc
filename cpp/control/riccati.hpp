#pragma once

#include <Eigen/Core>

namespace quadcore::control {

/// Return the gain K of the control u = -K x that minimises the integral of x^T Q x + r u^2 under
/// x' = A x + b u: K = b^T P / r, where P solves A^T P + P A - P b b^T P / r + Q = 0 (Anderson,
/// Moore, "Optimal Control", 1990, sec. 2.3). It uses the sign function of the Hamiltonian matrix
/// (Roberts, Int. J. Control 1980).
/// \param weights  diagonal of Q, >= 0; r > 0
/// Throws std::logic_error if (A, b) cannot be stabilised.
Eigen::RowVectorXd optimal_gain(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                const Eigen::VectorXd& weights, double r);

}  // namespace quadcore::control
