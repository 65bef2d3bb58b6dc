#pragma once

#include "sdf_numbers.hpp"

namespace quadcore {

/// Mass and inertia of a link as sdformat 9 lumps them: the inertia about the centre of mass along
/// the axes of `pose`, whatever is added to it.
struct SdfInertial {
  double mass = 0;
  SdfPose pose;
  Matrix3d inertia = Matrix3d::Zero();

  /// Adds a link that is fixed to this one at `joint`, in sdformat's order of operations. Rotations
  /// pass through urdf_rpy().
  void add(const SdfInertial& link, const SdfPose& joint);
};

}  // namespace quadcore
