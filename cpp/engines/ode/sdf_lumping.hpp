#pragma once

#include "sdf_numbers.hpp"

namespace quadcore {

/// Mass and inertia of a link as lumped by sdformat 9: the inertia about the centre of mass always
/// keeps the axes of `pose`.
struct SdfInertial {
  double mass = 0;
  SdfPose pose;
  Matrix3d inertia = Matrix3d::Zero();

  /// Add a link that is fixed to this one at `joint`, in sdformat's order of operations. Rotations
  /// pass through urdf_rpy().
  void add(const SdfInertial& link, const SdfPose& joint);
};

}  // namespace quadcore
