#pragma once

#include <vector>

#include "quadcore/control/reference.hpp"

namespace quadcore::control {

/// Position and yaw as pieces of polynomials of the seventh order between knots.
class SepticPath {
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
  /// From rest to rest between each row and the next.
  static SepticPath resting(const Rows& rows);

  Reference at(double t) const;
  double begin() const { return times_.front(); }
  double end() const { return times_.back(); }

 private:
  /// x, y, z and yaw in the columns; value, velocity, acceleration and jerk in the rows.
  using Knot = Eigen::Matrix4d;
  /// Coefficients of (t - t_i)/h, from the constant one on.
  using Piece = Eigen::Matrix<double, 8, 4>;

  explicit SepticPath(const Rows& rows);
  void connect();

  std::vector<double> times_;
  std::vector<Knot> knots_;
  std::vector<Piece> pieces_;
};

}  // namespace quadcore::control
