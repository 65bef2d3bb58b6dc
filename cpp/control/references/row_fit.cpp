#include "references/row_fit.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace quadcore::control {
namespace {

constexpr int order = 8;  ///< order of the B-splines: polynomials of degree seven
constexpr Eigen::Index fewest = 16;

using Sparse = Eigen::SparseMatrix<double>;

/// Return the nonzero B-splines of order k over equal intervals of length 1 at u in [0, 1] of one
/// interval, the earliest first (de Boor, "A Practical Guide to Splines", ch. X).
std::array<double, order> splines(int k, double u) {
  std::array<double, order> values{};
  values[0] = 1;
  for (int n = 2; n <= k; ++n) {
    for (int j = n - 1; j >= 0; --j) {
      const double begin = j - (n - 1);  // start of the j-th
      const double older = j > 0 ? values[static_cast<std::size_t>(j) - 1] : 0;
      values[static_cast<std::size_t>(j)] =
          ((u - begin) * older + (begin + n - u) * values[static_cast<std::size_t>(j)]) / (n - 1);
    }
  }
  return values;
}

/// Return the unit of the last decimal of the numbers, 1 to 1e-10.
double last_digit(const VectorXd& numbers) {
  constexpr double most = 1e10;
  double inverse = 1;  // a whole number, so the unit is rounded only once
  for (; inverse < most; inverse *= 10) {
    const double unit = 1 / inverse;
    const auto is_whole = [&](double x) {
      return std::abs(x - unit * std::round(x / unit)) <= 1e-13 * std::max(1.0, std::abs(x));
    };
    if (std::all_of(numbers.data(), numbers.data() + numbers.size(), is_whole)) break;
  }
  return 1 / inverse;
}

/// Fit so many pieces by least squares.
class Fit {
 public:
  Fit(const Rows& rows, Eigen::Index pieces)
      : begin_(rows(0, 0)),
        length_((rows(rows.rows() - 1, 0) - begin_) / static_cast<double>(pieces)),
        pieces_(pieces),
        basis_(rows.rows(), pieces + order - 1) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const double at = (rows(i, 0) - begin_) / length_;
      const auto piece =
          std::min(static_cast<Eigen::Index>(std::max(std::floor(at), 0.0)), pieces - 1);
      const auto values = splines(order, at - static_cast<double>(piece));
      for (int j = 0; j < order; ++j) {
        entries.emplace_back(i, piece + j, values[static_cast<std::size_t>(j)]);
      }
    }
    basis_.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Sparse> solver(Sparse(basis_.transpose() * basis_));
    const VectorXd pivots = solver.info() == Eigen::Success ? solver.vectorD() : VectorXd();
    // Splines without enough rows in their interval are undetermined.
    if (pivots.size() == 0 || pivots.minCoeff() < 1e-12 * pivots.maxCoeff()) return;
    const Eigen::MatrixXd places = rows.rightCols(rows.cols() - 1);
    factors_.setZero(basis_.cols(), places.cols());
    rest_ = places;
    for (int refinement = 0; refinement < 3; ++refinement) {
      factors_ += solver.solve(basis_.transpose() * rest_);
      rest_ = places - basis_ * factors_;
    }
  }

  bool is_within(const VectorXd& tolerances) const {
    if (factors_.size() == 0) return false;
    return (rest_.cwiseAbs().colwise().maxCoeff().transpose().array() <= tolerances.array()).all();
  }

  std::vector<SepticPath::Point> knots() const {
    std::vector<SepticPath::Point> knots;
    for (Eigen::Index i = 0; i <= pieces_; ++i) {
      const Eigen::Index piece = std::min(i, pieces_ - 1);
      const double u = i < pieces_ ? 0 : 1;
      SepticPath::Point knot;
      knot.t = begin_ + static_cast<double>(i) * length_;
      knot.given = {true, true, true};
      // The coefficients of a derivative are differences of the previous ones.
      Eigen::MatrixXd factors = factors_.middleRows(piece, order);
      for (int n = 0; n < 4; ++n) {
        const auto values = splines(order - n, u);
        for (int j = 0; j < order - n; ++j) {
          knot.derivatives.row(n).head(factors.cols()) +=
              values[static_cast<std::size_t>(j)] * factors.row(j);
        }
        const Eigen::Index left = factors.rows() - 1;
        factors = ((factors.bottomRows(left) - factors.topRows(left)) / length_).eval();
      }
      knots.push_back(knot);
    }
    return knots;
  }

 private:
  double begin_, length_;
  Eigen::Index pieces_;
  Sparse basis_;
  Eigen::MatrixXd factors_, rest_;
};

}  // namespace

VectorXd last_digits(const Rows& rows) {
  VectorXd units(rows.cols() - 1);
  for (Eigen::Index i = 0; i < units.size(); ++i) {
    units[i] = std::min(last_digit(rows.col(i + 1)), 1e-3);
  }
  return units;
}

std::vector<SepticPath::Point> fitted(const Rows& rows, const VectorXd& tolerances) {
  if (rows.rows() < fewest) return {};
  for (Eigen::Index pieces = 1; 4 * pieces <= rows.rows(); pieces *= 2) {
    const Fit fit(rows, pieces);
    if (fit.is_within(tolerances)) return fit.knots();
  }
  return {};
}

}  // namespace quadcore::control
