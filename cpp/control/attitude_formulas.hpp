#pragma once

#include "vehicle_numbers.hpp"

/// \file
/// The attitude controller as formulas for numbers or packs. Contains neither Eigen nor code, so
/// that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Gains of AttitudeGains by axes.
template <class T>
struct AttitudeNumbers {
  Vec3<T> p, d;
};

/// Product of each pair of components.
template <class T>
QUADCORE_LAW Vec3<T> by_components(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Return the unit quaternion of a rotation by more than 120 degrees (Shepperd, Journal of Guidance
/// and Control 1(3), 1978): it starts from the largest diagonal element.
QUADCORE_LAW Quaternion<double> quaternion_of_large_turn(const Matrix3<double>& R) {
  const double m[3][3] = {{R.xx, R.xy, R.xz}, {R.yx, R.yy, R.yz}, {R.zx, R.zy, R.zz}};
  int i = m[1][1] > m[0][0] ? 1 : 0;
  if (m[2][2] > m[i][i]) i = 2;
  const int j = (i + 1) % 3, k = (j + 1) % 3;
  const double root = laws::square_root(m[i][i] - m[j][j] - m[k][k] + 1);
  const double by = 0.5 / root;
  double u[3];
  u[i] = 0.5 * root;
  u[j] = (m[j][i] + m[i][j]) * by;
  u[k] = (m[k][i] + m[i][k]) * by;
  return {u[0], u[1], u[2], (m[k][j] - m[j][k]) * by};
}

/// Return the unit quaternion of a rotation matrix.
template <class T>
QUADCORE_LAW Quaternion<T> quaternion_of(const Matrix3<T>& R) {
  const T trace = R.xx + (R.yy + R.zz);
  const T root = laws::square_root(trace + 1), by = 0.5 * laws::inverse_root(trace + 1);
  Quaternion<T> q{(R.zy - R.yz) * by, (R.xz - R.zx) * by, (R.yx - R.xy) * by, 0.5 * root};
  if (__builtin_expect(!laws::any(trace <= 0), 1)) return q;
  if constexpr (laws::lanes_of<T> == 1) {
    return quaternion_of_large_turn(R);
  } else {
    for (int i = 0; i < laws::lanes_of<T>; ++i) {
      if (trace[i] > 0) continue;
      const Quaternion<double> one = quaternion_of_large_turn(
          {R.xx[i], R.xy[i], R.xz[i], R.yx[i], R.yy[i], R.yz[i], R.zx[i], R.zy[i], R.zz[i]});
      q.x[i] = one.x;
      q.y[i] = one.y;
      q.z[i] = one.z;
      q.w[i] = one.w;
    }
    return q;
  }
}

/// Return the attitude error of a rotation to the wanted attitude: 2 sign(q_w) q_vec. It grows up
/// to half a turn (Mayhew, Sanfelice, Teel, IEEE TAC 2011), while the error from rotation matrices
/// vanishes there.
template <class T>
QUADCORE_LAW Vec3<T> attitude_error(const Quaternion<T>& q_FD) {
  const T twice = laws::chosen_by(q_FD.w < 0, laws::broadcast<T>(-2), laws::broadcast<T>(2));
  return {twice * q_FD.x, twice * q_FD.y, twice * q_FD.z};
}

/// See AttitudeLoop::angular_acceleration().
template <class T>
QUADCORE_LAW Vec3<T> angular_acceleration(const AttitudeNumbers<T>& gains,
                                          const Quaternion<T>& q_FD, const Vec3<T>& w_error_F) {
  return by_components(gains.p, attitude_error(q_FD)) + by_components(gains.d, w_error_F);
}

/// See AttitudeLoop::torque().
template <class T>
QUADCORE_LAW Vec3<T> attitude_torque(const VehicleNumbers<T>& vehicle, bool drag, bool gyroscopic,
                                     const Matrix3<T>& R_WF, const Vec3<T>& v_WF_W,
                                     const Vec3<T>& w_WF_F, const Vec3<T>& h_F,
                                     const Vec3<T>& dw_WF_F) {
  const Vec3<T> none{T{}, T{}, T{}};
  const Vec3<T> tau_air_F =
      drag ? air_torque_F(vehicle, laws::inversely(R_WF, v_WF_W), w_WF_F) : none;
  return torque_for(vehicle.inertia_Ccm_F, dw_WF_F, w_WF_F, gyroscopic ? h_F : none, tau_air_F);
}

/// Return the orientation with z along the given nonzero direction and x in the vertical plane of a
/// yaw, relative to the axes of the arguments.
/// \param across  across_yaw()
template <class T>
QUADCORE_LAW Matrix3<T> attitude_of(const Vec3<T>& direction, const Vec3<T>& across) {
  const Vec3<T> z = normalised(direction);
  const Vec3<T> x = normalised(cross(across, direction));  // need not wait for z
  const Vec3<T> y = cross(z, x);
  return {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
}

}  // namespace quadcore::control
