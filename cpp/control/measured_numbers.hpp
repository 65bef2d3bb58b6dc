#pragma once

#include "lanes/quaternion.hpp"

namespace quadcore::control {

/// Measured motion of a vehicle as plain numbers or packs, see InputNumbers.
template <class T>
struct MeasuredNumbers {
  laws::Vec3<T> position;
  laws::Quaternion<T> q_WF;
  laws::Vec3<T> v_WF_W, w_WF_F;
};

}  // namespace quadcore::control
