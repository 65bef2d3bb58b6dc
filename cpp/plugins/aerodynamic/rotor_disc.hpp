#pragma once

#include "quadcore/spatial.hpp"

namespace quadcore::aerodynamic {

/// A rotor as its force laws see it. All vectors in the frame's axes F.
struct RotorDisc {
  Vector3d axis_F;  ///< unit normal of the disc, along which it lifts
  Vector3d v_F;     ///< velocity of the rotor (through the air, if the drag model knows wind) [m/s]
  double speed;     ///< real rotor speed: joint rate x sim_slow [rad/s]

  /// Component of a vector in the disc's plane.
  Vector3d in_plane(const Vector3d& a_F) const { return a_F - axis_F.dot(a_F) * axis_F; }
};

}  // namespace quadcore::aerodynamic
