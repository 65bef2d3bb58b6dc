#pragma once

#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore::control {

/// W of thesis eq. (2.9), w_WF_F = W d(rpy)/dt, and its time derivative.
struct EulerRates {
  Matrix3d W, dW;
};

/// \param rates  d(rpy)/dt [rad/s]
inline EulerRates euler_rates(const Vector3d& rpy, const Vector3d& rates) {
  const auto [s_roll, c_roll] = elementary::sincos(rpy.x());
  const auto [s_pitch, c_pitch] = elementary::sincos(rpy.y());
  const double roll_rate = rates.x(), pitch_rate = rates.y();
  EulerRates e;
  e.W << 1, 0, -s_pitch,            //
      0, c_roll, s_roll * c_pitch,  //
      0, -s_roll, c_roll * c_pitch;
  e.dW << 0, 0, -c_pitch * pitch_rate,                                                       //
      0, -s_roll * roll_rate, c_roll * c_pitch * roll_rate - s_roll * s_pitch * pitch_rate,  //
      0, -c_roll * roll_rate, -s_roll * c_pitch * roll_rate - c_roll * s_pitch * pitch_rate;
  return e;
}

/// Return d(rpy)/dt of a frame with angular velocity w_WF_F; infinite or NaN at a pitch of 90
/// degrees.
inline Vector3d rates_of(const Vector3d& rpy, const Vector3d& w_WF_F) {
  const auto [s_roll, c_roll] = elementary::sincos(rpy.x());
  const auto [s_pitch, c_pitch] = elementary::sincos(rpy.y());
  const double across = s_roll * w_WF_F.y() + c_roll * w_WF_F.z();
  return {w_WF_F.x() + s_pitch / c_pitch * across, c_roll * w_WF_F.y() - s_roll * w_WF_F.z(),
          across / c_pitch};
}

/// Return the equivalent angle in [-pi, pi].
inline double wrap_angle(double angle) { return std::remainder(angle, 2 * M_PI); }

}  // namespace quadcore::control
