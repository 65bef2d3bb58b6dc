#pragma once

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/spatial.hpp"

/// \file
/// A point of a compliant body against the ground.

namespace quadcore::laws {

/// Faster than this a point leaves the ground without being pushed, while it is hardly in it [m/s].
constexpr double parting_speed = 0.01;

/// Force of the ground on a point that is `depth` deep and sinks at `rate` (K. H. Hunt,
/// F. R. E. Crossley, "Coefficient of restitution interpreted as damping in vibroimpact", J.
/// Applied Mechanics 42, 1975, eq. (8), exponent 1) [N]. Its damping grows with the depth up to
/// stiffness * relaxation, and the ground does not pull.
/// \param stiffness   N/m
/// \param relaxation  s
inline double pressure(double stiffness, double relaxation, double depth, double rate) {
  if (depth <= 0) return 0;
  return stiffness * std::max(0.0, depth + std::min(depth / parting_speed, relaxation) * rate);
}

/// What resists a patch that is moved along the ground, divided by lengths to forces: along the
/// ground; about the normal, by the patch's radius; about the two directions along the ground, by
/// the rolling lever.
using Resistance = Eigen::Matrix<double, 5, 1>;

/// A part of a shape's reach, small so that rolling adds little to what a step has to follow.
constexpr double rolling_lever = 0.1;
/// How far off what presses may act where a shape rolls, as a part of the shape's reach: the
/// coefficient of rolling resistance, here that of a tyre on concrete.
constexpr double rolling_resistance = 0.01;

/// The part of a vector that is within an ellipsoid; a semiaxis may be 0.
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

/// The part of a resistance that is possible [N]: Coulomb's friction within an ellipsoid
/// (R. D. Howe, M. R. Cutkosky, "Practical force-motion models for sliding manipulation", Int. J.
/// Robotics Research 15, 1996), that to rolling within a circle.
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
