#pragma once

#include <ode/ode.h>

#include <array>

#include "quadcore/plugin/spatial.hpp"

/// \file
/// ODE's arrays as Eigen objects.

namespace quadcore {

inline Eigen::Map<const Vector3d> vec(const dReal* v) { return Eigen::Map<const Vector3d>(v); }

/// Return the rotation of a body, R_WB (ODE pads its rows to four).
inline Matrix3d rotation(const dReal* R) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>, 0, Eigen::OuterStride<4>>(
      R);
}

/// Return two unit vectors perpendicular to a unit vector, as chosen by ODE.
inline std::array<Vector3d, 2> plane_space(const Vector3d& n) {
  const dVector3 ode_n = {n.x(), n.y(), n.z()};
  dVector3 p, q;
  dPlaneSpace(ode_n, p, q);
  return {vec(p), vec(q)};
}

}  // namespace quadcore
