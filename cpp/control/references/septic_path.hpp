#pragma once

#include <array>
#include <vector>

#include "quadcore/control/reference.hpp"

namespace quadcore::control {

/// Position and yaw as piecewise polynomials of degree seven between knots.
class SepticPath final : public ReferenceShape {
 public:
  enum class Ends {
    at_rest,  ///< velocity, acceleration and jerk are zero: waypoints from hover to hover
    free,     ///< the fourth to sixth derivatives are zero: a piece of a longer motion
  };

  /// Create the smoothest path through all rows with these ends: the one with the minimum integral
  /// of squared snap, a spline of degree seven with six continuous derivatives (Mellinger, Kumar,
  /// ICRA 2011, eq. 11 with given times). Throws InputError for times that do not increase or fewer
  /// than two rows.
  static SepticPath smoothest(const Rows& rows, Ends ends);
  /// Conditions at one time of a path.
  struct Point {
    double t;
    /// x, y, z and yaw in the columns; value, velocity, acceleration and jerk in the rows.
    Eigen::Matrix4d derivatives = Eigen::Matrix4d::Zero();
    /// Whether velocity, acceleration and jerk are given; otherwise they are chosen for the
    /// smoothest path.
    std::array<bool, 3> given = {false, false, false};
  };
  /// Create the smoothest path through points. Throws InputError for times that do not increase or
  /// fewer than two points.
  static SepticPath smoothest(const std::vector<Point>& points);
  /// Create a path that is at rest at each row.
  static SepticPath resting(const Rows& rows);

  Reference at(double t) const override;
  double begin() const { return times_.front(); }
  double end() const override { return times_.back(); }

 private:
  using Knot = Eigen::Matrix4d;  ///< like Point::derivatives
  /// Coefficients of powers of (t - t_i)/h, starting with the constant.
  using Piece = Eigen::Matrix<double, 8, 4>;

  explicit SepticPath(const std::vector<Point>& points);
  void connect();

  std::vector<double> times_;
  std::vector<Knot> knots_;
  std::vector<Piece> pieces_;
};

}  // namespace quadcore::control
