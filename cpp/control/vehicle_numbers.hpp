#pragma once

#include "air_force.hpp"
#include "lanes/inverse_root.hpp"
#include "lanes/quaternion.hpp"

/// \file
/// The modelled vehicle as plain numbers or packs: its air resistance and its equation of rotation.
/// Contains neither Eigen nor code, so that files compiled for a specific processor can include it.

namespace quadcore::control {

using laws::Matrix3;
using laws::Quaternion;
using laws::Vec3;

/// The parts of ModelledVehicle that control laws depend on, except the rotors.
template <class T>
struct VehicleNumbers {
  T mass, gravity;
  Vec3<T> p_FCcm_F;
  Matrix3<T> inertia_Ccm_F;
  AirNumbers<T> air;
  /// AirResistance::linear of torque and velocity, and of torque and angular velocity.
  Matrix3<T> torque_by_velocity, torque_by_rate;
};

/// Return the velocity of the centre of mass in F for a velocity of the origin.
template <class T>
QUADCORE_LAW Vec3<T> v_WCcm_F(const VehicleNumbers<T>& vehicle, const Vec3<T>& v_WF_F,
                              const Vec3<T>& w_WF_F) {
  return v_WF_F + cross(w_WF_F, vehicle.p_FCcm_F);
}

/// Return the aerodynamic torque about the centre of mass in F [N m].
template <class T>
QUADCORE_LAW Vec3<T> air_torque_F(const VehicleNumbers<T>& vehicle, const Vec3<T>& v_WF_F,
                                  const Vec3<T>& w_WF_F) {
  const Vec3<T> torque_F = vehicle.torque_by_velocity * v_WCcm_F(vehicle, v_WF_F, w_WF_F) +
                           vehicle.torque_by_rate * w_WF_F;
  return {-torque_F.x, -torque_F.y, -torque_F.z};
}

/// See torque_for() in flat_state.hpp.
template <class T>
QUADCORE_LAW Vec3<T> torque_for(const Matrix3<T>& inertia_Ccm_F, const Vec3<T>& dw_WF_F,
                                const Vec3<T>& w_WF_F, const Vec3<T>& h_F,
                                const Vec3<T>& tau_air_F) {
  return (inertia_Ccm_F * dw_WF_F + cross(w_WF_F, inertia_Ccm_F * w_WF_F + h_F)) - tau_air_F;
}

/// Return the product of the transpose of a matrix and another matrix.
template <class T>
QUADCORE_LAW Matrix3<T> inversely(const Matrix3<T>& A, const Matrix3<T>& B) {
  const Vec3<T> x = laws::inversely(A, Vec3<T>{B.xx, B.yx, B.zx}),
                y = laws::inversely(A, Vec3<T>{B.xy, B.yy, B.zy}),
                z = laws::inversely(A, Vec3<T>{B.xz, B.yz, B.zz});
  return {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
}

/// Return a vector divided by its norm, or the null vector.
template <class T>
QUADCORE_LAW Vec3<T> normalised(const Vec3<T>& a) {
  const T square = dot(a, a);
  const T factor = laws::chosen_by(square > 0, laws::inverse_root(square), laws::broadcast<T>(1));
  return factor * a;
}

}  // namespace quadcore::control
