#pragma once

#include "laws/angles.hpp"
#include "vehicle_numbers.hpp"

/// \file
/// Roll, pitch and yaw and their rates as formulas for numbers or packs. Contains neither Eigen nor
/// code, so that files compiled for a specific processor can include it.

namespace quadcore::control {

using laws::SineCosine;

/// Return the sine and cosine of an angle for their products with a positive factor.
template <class T>
QUADCORE_LAW SineCosine<T> normalised(const SineCosine<T>& a) {
  const T factor = laws::inverse_root(a.sin * a.sin + a.cos * a.cos);
  return {factor * a.sin, factor * a.cos};
}

/// Return the angle in [-pi, pi] from one angle to another [rad]. Their sines and cosines may have
/// positive factors.
template <class T>
QUADCORE_LAW T angle_between(const SineCosine<T>& from, const SineCosine<T>& to) {
  return laws::arc_tangent(to.sin * from.cos - to.cos * from.sin,
                           to.cos * from.cos + to.sin * from.sin);
}

/// Roll, pitch and yaw of a frame F, and the W of thesis eq. (2.9), which converts their rates to
/// its angular velocity: w_WF_F = W d(rpy)/dt.
template <class T>
struct EulerAngles {
  SineCosine<T> roll, pitch, yaw;

  /// The least square of the cosine of the pitch has the size of its rounding errors, so that
  /// by_inverse_W() stays finite.
  explicit QUADCORE_LAW EulerAngles(const Matrix3<T>& R_WF)
      : pitch{-R_WF.zx, laws::square_root(R_WF.zy * R_WF.zy + R_WF.zz * R_WF.zz + 1e-32)} {
    const laws::RollAndYaw<T> others = laws::roll_and_yaw(R_WF);
    roll = normalised(others.roll);
    yaw = normalised(others.yaw);
  }

  /// Return W times a vector.
  QUADCORE_LAW Vec3<T> by_W(const Vec3<T>& a) const {
    return {a.x - pitch.sin * a.z, roll.cos * a.y + roll.sin * pitch.cos * a.z,
            roll.cos * pitch.cos * a.z - roll.sin * a.y};
  }
  /// Return the inverse of W times a vector; huge at a pitch of 90 degrees, where W is singular.
  QUADCORE_LAW Vec3<T> by_inverse_W(const Vec3<T>& a) const {
    const T of_yaw = (roll.sin * a.y + roll.cos * a.z) / pitch.cos;
    return {a.x + pitch.sin * of_yaw, roll.cos * a.y - roll.sin * a.z, of_yaw};
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
