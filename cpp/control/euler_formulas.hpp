#pragma once

#include "laws/angles.hpp"
#include "vehicle_numbers.hpp"

/// \file
/// Roll, pitch and yaw and their rates as formulas for numbers or packs. Contains neither Eigen nor
/// code, so that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Roll, pitch and yaw of a frame F, and the W of thesis eq. (2.9), which converts their rates to
/// its angular velocity: w_WF_F = W d(rpy)/dt.
template <class T>
struct EulerAngles {
  Vec3<T> rpy;  ///< rad
  laws::SineCosine<T> roll, pitch;

  explicit QUADCORE_LAW EulerAngles(const Matrix3<T>& R_WF)
      : rpy(laws::roll_pitch_yaw(R_WF)),
        roll(laws::sine_and_cosine(rpy.x)),
        pitch(laws::sine_and_cosine(rpy.y)) {}

  /// Return W times a vector.
  QUADCORE_LAW Vec3<T> by_W(const Vec3<T>& a) const {
    return {a.x - pitch.sin * a.z, roll.cos * a.y + roll.sin * pitch.cos * a.z,
            roll.cos * pitch.cos * a.z - roll.sin * a.y};
  }
  /// Return the inverse of W times a vector; infinite or NaN at a pitch of 90 degrees.
  QUADCORE_LAW Vec3<T> by_inverse_W(const Vec3<T>& a) const {
    const T across = roll.sin * a.y + roll.cos * a.z;
    return {a.x + pitch.sin / pitch.cos * across, roll.cos * a.y - roll.sin * a.z,
            across / pitch.cos};
  }
  /// Return the time derivative of W times the rates of roll, pitch and yaw.
  QUADCORE_LAW Vec3<T> by_dW(const Vec3<T>& rates) const {
    return {-pitch.cos * rates.y * rates.z,
            (roll.cos * pitch.cos * rates.x - roll.sin * pitch.sin * rates.y) * rates.z -
                roll.sin * rates.x * rates.y,
            (-roll.sin * pitch.cos * rates.x - roll.cos * pitch.sin * rates.y) * rates.z -
                roll.cos * rates.x * rates.y};
  }
};

}  // namespace quadcore::control
