#pragma once

#include <ode/ode.h>

#include "quadcore/spatial.hpp"

/// \file
/// ODE's arrays as Eigen objects.

namespace quadcore {

inline Eigen::Map<const Vector3d> vec(const dReal* v) { return Eigen::Map<const Vector3d>(v); }

/// Rotation of a body, R_WB (ODE pads its rows to four).
inline Matrix3d rotation(const dReal* R) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>, 0, Eigen::OuterStride<4>>(R);
}

}  // namespace quadcore
