#pragma once

#include "lanes/vec3.hpp"

namespace quadcore::laws {

/// A rotor as its force laws see it. All vectors in the frame's axes F.
template <class T>
struct RotorDisc {
  Vec3<T> axis_F;  ///< unit normal of the disc, along which it lifts
  T speed;         ///< real rotor speed: joint rate x sim_slow [rad/s]
  T share;         ///< of thrust and reaction torque that a damaged rotor has left
  Vec3<T> V_F;     ///< in-plane velocity (through the air, if the drag model knows wind) [m/s]
};

/// Component of a vector in the plane across a unit axis.
template <class T>
QUADCORE_LAW Vec3<T> across(const Vec3<T>& axis, const Vec3<T>& a) {
  return a - dot(axis, a) * axis;
}

}  // namespace quadcore::laws
