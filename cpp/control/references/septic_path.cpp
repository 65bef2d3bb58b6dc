#include "references/septic_path.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "quadcore/plugin/error.hpp"

namespace quadcore::control {
namespace {

using Matrix48 = Eigen::Matrix<double, 4, 8>;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// Return k (k - 1)...(k - n + 1), the factor of the n-th derivative of the power k.
double falling(int k, int n) {
  double product = 1;
  for (int i = 0; i < n; ++i) product *= k - i;
  return product;
}

/// Return the upper four coefficients of the piece over [0, 1] with the derivatives 0 to 3 at its
/// left (columns 0 to 3) and right end (columns 4 to 7). The lower four are the left derivatives
/// divided by k!.
Matrix48 upper_coefficients() {
  Eigen::Matrix4d of_lower, of_upper;
  for (int n = 0; n < 4; ++n) {
    for (int k = 0; k < 4; ++k) {
      of_lower(n, k) = falling(k, n) / falling(k, k);
      of_upper(n, k) = falling(k + 4, n);
    }
  }
  const Eigen::Matrix4d inverse = of_upper.inverse();
  Matrix48 upper;
  upper << -inverse * of_lower, inverse;
  return upper;
}

const Matrix48& upper() {
  static const Matrix48 coefficients = upper_coefficients();
  return coefficients;
}

/// Return the factors of the derivatives 0 to 3 that scale a piece of length h to length 1.
Eigen::Vector4d lengths(double h) { return {1, h, h * h, h * h * h}; }

/// Return the derivatives 4 to 6 of a piece of length h at its start or end, as a linear function
/// of the derivatives 0 to 3 at both ends.
Eigen::Matrix<double, 3, 8> high_derivatives(double h, bool at_its_end) {
  Eigen::Matrix<double, 3, 4> of_upper = Eigen::Matrix<double, 3, 4>::Zero();
  double power = h * h * h * h;
  for (int n = 4; n < 7; ++n, power *= h) {
    for (int k = n; k < 8; ++k) {
      if (k == n || at_its_end) of_upper(n - 4, k - 4) = falling(k, n) / power;
    }
  }
  Eigen::Matrix<double, 8, 1> scale;
  scale << lengths(h), lengths(h);
  return of_upper * upper() * scale.asDiagonal();
}

/// One row of blocks of the equations for the derivatives 1 to 3 of all knots.
struct Equation {
  Eigen::Matrix3d before = Eigen::Matrix3d::Zero(), own = Eigen::Matrix3d::Zero(),
                  after = Eigen::Matrix3d::Zero();
  Matrix34 right = Matrix34::Zero();

  /// Replace one of the three equations by the value of an unknown.
  void fix(int equation, int unknown, const Eigen::RowVector4d& value) {
    before.row(equation).setZero();
    after.row(equation).setZero();
    own.row(equation) = Eigen::RowVector3d::Unit(unknown);
    right.row(equation) = value;
  }
};

std::vector<SepticPath::Point> points_of(const Rows& rows) {
  if (rows.rows() < 2 || (rows.cols() != 4 && rows.cols() != 5)) {
    throw InputError(
        "the path has fewer than two rows, or rows of wrong length. Give at least two rows of t, "
        "x, y, z or t, x, y, z, yaw.");
  }
  std::vector<SepticPath::Point> points;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    points.emplace_back();
    points.back().t = rows(i, 0);
    points.back().derivatives.row(0).head(rows.cols() - 1) = rows.row(i).tail(rows.cols() - 1);
  }
  return points;
}

}  // namespace

SepticPath::SepticPath(const std::vector<Point>& points) {
  if (points.size() < 2) throw InputError("the path has fewer than two points. Give at least two.");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].t) || !points[i].derivatives.allFinite()) {
      throw InputError("the path contains a number that is not finite. Give finite numbers.");
    }
    if (i > 0 && !(points[i].t > points[i - 1].t)) {
      throw InputError("row " + std::to_string(i + 1) +
                       " of the path is not later than the one before. Sort the points by time.");
    }
    times_.push_back(points[i].t);
    knots_.push_back(points[i].derivatives);
  }
}

SepticPath SepticPath::resting(const Rows& rows) {
  SepticPath path(points_of(rows));
  path.connect();
  return path;
}

SepticPath SepticPath::smoothest(const Rows& rows, Ends ends) {
  std::vector<Point> points = points_of(rows);
  const bool rests = ends == Ends::at_rest;
  points.front().given = points.back().given = {rests, rests, rests};
  return smoothest(points);
}

SepticPath SepticPath::smoothest(const std::vector<Point>& points) {
  SepticPath path(points);
  std::vector<Knot>& knots = path.knots_;
  const std::size_t n = knots.size();
  std::vector<Equation> equations(n);
  for (std::size_t i = 0; i < n; ++i) {
    Equation& e = equations[i];
    // The derivatives 4 to 6 of adjacent pieces agree; at a free end they are zero.
    if (i > 0) {
      const auto left = high_derivatives(path.times_[i] - path.times_[i - 1], true);
      e.before += left.middleCols<3>(1);
      e.own += left.rightCols<3>();
      e.right -= left.col(0) * knots[i - 1].row(0) + left.col(4) * knots[i].row(0);
    }
    if (i + 1 < n) {
      const auto right = high_derivatives(path.times_[i + 1] - path.times_[i], false);
      e.own -= right.middleCols<3>(1);
      e.after -= right.rightCols<3>();
      e.right += right.col(0) * knots[i].row(0) + right.col(4) * knots[i + 1].row(0);
    }
    // The equation of derivative 7 - k determines the free derivative k.
    for (int k = 1; k < 4; ++k) {
      if (points[i].given[static_cast<std::size_t>(k) - 1]) e.fix(3 - k, k - 1, knots[i].row(k));
    }
  }
  // Elimination by blocks of three.
  for (std::size_t i = 0; i < n; ++i) {
    Equation& e = equations[i];
    if (i > 0) {
      e.own -= e.before * equations[i - 1].after;
      e.right -= e.before * equations[i - 1].right;
    }
    const Eigen::PartialPivLU<Eigen::Matrix3d> solver(e.own);
    e.after = solver.solve(e.after).eval();
    e.right = solver.solve(e.right).eval();
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) equations[i].right -= equations[i].after * knots[i + 1].bottomRows<3>();
    knots[i].bottomRows<3>() = equations[i].right;
  }
  path.connect();
  return path;
}

void SepticPath::connect() {
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const Eigen::Vector4d scale = lengths(times_[i + 1] - times_[i]);
    Eigen::Matrix<double, 8, 4> ends;
    ends << scale.asDiagonal() * knots_[i], scale.asDiagonal() * knots_[i + 1];
    Piece piece;
    for (int k = 0; k < 4; ++k) piece.row(k) = ends.row(k) / falling(k, k);
    piece.bottomRows<4>() = upper() * ends;
    pieces_.push_back(piece);
  }
}

Reference SepticPath::at(double t) const {
  Reference wanted;
  Eigen::Matrix<double, 5, 4> derivatives = Eigen::Matrix<double, 5, 4>::Zero();
  if (!(t >= begin() && t < end())) {  // false for NaN, too
    derivatives.row(0) = (t < begin() ? knots_.front() : knots_.back()).row(0);
  } else {
    const auto next = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
    const auto i = static_cast<std::size_t>(next) - 1;
    const double h = times_[i + 1] - times_[i];
    const double u = (t - times_[i]) / h;
    double power = 1;
    for (int n = 0; n < 5; ++n, power *= h) {
      for (int k = 7; k >= n; --k) {
        derivatives.row(n) = derivatives.row(n) * u + falling(k, n) * pieces_[i].row(k);
      }
      derivatives.row(n) /= power;
    }
  }
  wanted.position = derivatives.row(0).head<3>();
  wanted.velocity = derivatives.row(1).head<3>();
  wanted.acceleration = derivatives.row(2).head<3>();
  wanted.jerk = derivatives.row(3).head<3>();
  wanted.snap = derivatives.row(4).head<3>();
  wanted.yaw = derivatives(0, 3);
  wanted.yaw_rate = derivatives(1, 3);
  wanted.yaw_acceleration = derivatives(2, 3);
  return wanted;
}

}  // namespace quadcore::control
