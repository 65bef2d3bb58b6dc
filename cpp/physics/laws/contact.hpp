#pragma once

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/spatial.hpp"

/// \file
/// Contact of a point of a compliant body with the ground.

namespace quadcore::laws {

/// Speed above which a point at small depth leaves the ground without a force [m/s].
constexpr double parting_speed = 0.01;

/// Return the force of the ground on a point at `depth` that sinks at `rate` (K. H. Hunt, F. R. E.
/// Crossley, "Coefficient of restitution interpreted as damping in vibroimpact", J. Applied
/// Mechanics 42, 1975, eq. (8), exponent 1) [N]. Its damping grows with the depth up to stiffness *
/// relaxation, and the ground does not pull.
/// \param stiffness   N/m
/// \param relaxation  s
inline double pressure(double stiffness, double relaxation, double depth, double rate) {
  if (depth <= 0) return 0;
  return stiffness * std::max(0.0, depth + std::min(depth / parting_speed, relaxation) * rate);
}

/// Resistance of a patch that moves along the ground, as forces: along the ground; about the
/// normal, divided by the patch's radius; about the two directions along the ground, divided by the
/// rolling lever.
using Resistance = Eigen::Matrix<double, 5, 1>;

/// A fraction of a shape's reach, small so that rolling hardly affects the required time step.
constexpr double rolling_lever = 0.1;
/// Offset of the normal force of a rolling shape as a fraction of its reach: the coefficient of
/// rolling resistance, here that of a tyre on concrete.
constexpr double rolling_resistance = 0.01;

/// Shorten a vector to an ellipsoid; semiaxes may be 0.
template <int n>
Eigen::Matrix<double, n, 1> within(const Eigen::Matrix<double, n, 1>& semiaxes,
                                   const Eigen::Matrix<double, n, 1>& vector) {
  Eigen::Matrix<double, n, 1> allowed = vector;
  double square = 0;
  for (int i = 0; i < n; ++i) {
    if (!(semiaxes[i] > 0)) {
      allowed[i] = 0;
      continue;
    }
    const double share = vector[i] / semiaxes[i];
    square += share * share;
  }
  if (square > 1) allowed /= std::sqrt(square);
  return allowed;
}

/// Limit a resistance [N]: Coulomb friction to an ellipsoid (R. D. Howe, M. R. Cutkosky, "Practical
/// force-motion models for sliding manipulation", Int. J. Robotics Research 15, 1996), rolling
/// resistance to a circle.
/// \param friction  semiaxes of the ellipsoid [N]
/// \param pressing  the normal force [N]
inline Resistance possible(const Vector3d& friction, double pressing, const Resistance& wanted) {
  Resistance possible;
  possible.head<3>() = within<3>(friction, wanted.head<3>());
  const double rolling = rolling_resistance / rolling_lever * pressing;
  possible.tail<2>() = within<2>({rolling, rolling}, wanted.tail<2>());
  return possible;
}

}  // namespace quadcore::laws
