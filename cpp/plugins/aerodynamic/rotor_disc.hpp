#pragma once

#include "quadcore/spatial.hpp"

namespace quadcore::aerodynamic {

/// A rotor as its force laws see it. All vectors in the frame's axes F.
struct RotorDisc {
  Vector3d axis_F;  ///< unit normal of the disc, along which it lifts
  double speed;     ///< real rotor speed: joint rate x sim_slow [rad/s]
  Vector3d V_F;     ///< in-plane velocity (through the air, if the drag model knows wind) [m/s]

  RotorDisc(const Vector3d& axis, double rotor_speed, const Vector3d& velocity)
      : axis_F(axis), speed(rotor_speed), V_F(in_plane(velocity)) {}

  /// Component of a vector in the disc's plane.
  Vector3d in_plane(const Vector3d& a_F) const { return a_F - axis_F.dot(a_F) * axis_F; }
};

}  // namespace quadcore::aerodynamic
