#pragma once

#include "lanes/vec3.hpp"

namespace quadcore::laws {

/// Input of a rotor's force laws. All vectors are in the frame's axes F.
template <class T>
struct RotorDisc {
  Vec3<T> axis_F;  ///< unit normal of the disc in the direction of thrust
  T speed;         ///< real rotor speed: joint rate x sim_slow [rad/s]
  T share;         ///< remaining fraction of thrust and reaction torque
  Vec3<T> V_F;  ///< in-plane velocity (relative to the air, if the drag model includes wind) [m/s]
};

/// Return the component of a vector perpendicular to a unit axis.
template <class T>
QUADCORE_LAW Vec3<T> across(const Vec3<T>& axis, const Vec3<T>& a) {
  return a - dot(axis, a) * axis;
}

}  // namespace quadcore::laws
