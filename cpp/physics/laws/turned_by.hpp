#pragma once

#include "lanes/quaternion.hpp"

namespace quadcore::laws {

/// Return the orientation after ODE's step (dxStepBody): q + dt/2 w q, not normalised.
/// \param h_W  dt/2 times the body's angular velocity, in W
template <class T>
QUADCORE_LAW Quaternion<T> turned_by(const Vec3<T>& h_W, const Quaternion<T>& q) {
  return {q.x + (h_W.x * q.w + (h_W.y * q.z - h_W.z * q.y)),
          q.y + (h_W.y * q.w + (h_W.z * q.x - h_W.x * q.z)),
          q.z + (h_W.z * q.w + (h_W.x * q.y - h_W.y * q.x)),
          q.w - (h_W.x * q.x + (h_W.y * q.y + h_W.z * q.z))};
}

}  // namespace quadcore::laws
