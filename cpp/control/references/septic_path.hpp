#pragma once

#include <array>
#include <vector>

#include "quadcore/control/reference.hpp"

namespace quadcore::control {

/// Position and yaw as pieces of polynomials of the seventh order between knots.
class SepticPath final : public ReferenceShape {
 public:
  enum class Ends {
    at_rest,  ///< velocity, acceleration and jerk are zero: the waypoints of a vehicle that hovers
    free,     ///< the fourth to sixth derivative are zero: a piece of a longer motion
  };

  /// The smoothest path: of all with these ends through all rows, the one with the least integral
  /// of squared snap, which is a spline of the seventh order whose first six derivatives are
  /// continuous (Mellinger, Kumar, ICRA 2011, eq. 11 with times given).
  /// Throws InputError on rows whose times do not grow, or on fewer than two.
  static SepticPath smoothest(const Rows& rows, Ends ends);
  /// What is wanted at one time of a path.
  struct Point {
    double t;
    /// x, y, z and yaw in the columns; value, velocity, acceleration and jerk in the rows.
    Eigen::Matrix4d derivatives = Eigen::Matrix4d::Zero();
    /// Whether the velocity, the acceleration and the jerk are wanted, or what is smoothest.
    std::array<bool, 3> given = {false, false, false};
  };
  /// The smoothest path through points. Throws InputError on times that do not grow, or on fewer
  /// than two points.
  static SepticPath smoothest(const std::vector<Point>& points);
  /// From rest to rest between each row and the next.
  static SepticPath resting(const Rows& rows);

  Reference at(double t) const override;
  double begin() const { return times_.front(); }
  double end() const override { return times_.back(); }

 private:
  using Knot = Eigen::Matrix4d;  ///< as Point::derivatives
  /// Coefficients of (t - t_i)/h, from the constant one on.
  using Piece = Eigen::Matrix<double, 8, 4>;

  explicit SepticPath(const std::vector<Point>& points);
  void connect();

  std::vector<double> times_;
  std::vector<Knot> knots_;
  std::vector<Piece> pieces_;
};

}  // namespace quadcore::control
