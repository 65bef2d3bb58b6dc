#pragma once

#include "vec3.hpp"

namespace quadcore::laws {

/// A rigid body with n axisymmetric rotors on continuous joints, in reduced coordinates. Because
/// each rotor's centre of mass lies on its axis and its inertia is symmetric about it, the mass
/// distribution does not change as the rotors turn. Notation: C the vehicle's centre of mass, w the
/// frame's rate, W_i the rate of joint i, a_i its axis, J_i the rotor's moment about it.
///
/// Angular momentum about C (e.g. Hughes, "Spacecraft Attitude Dynamics", ch. 6):
///   H = I_C w + sum J_i W_i a_i,   dH/dt + w x H = tau,
/// and of each rotor about its axis, q_i the torque of its joint:
///   J_i (dW_i/dt + a_i . dw/dt) = q_i.
/// Eliminating dW_i/dt leaves (I_C - sum J_i a_i a_i^T) dw/dt = tau - w x H - sum q_i a_i.
/// \file

/// What rotors contribute to the equations of the frame.
template <class T>
struct RotorShare {
  Vec3<T> f_F;    ///< force [N]
  Vec3<T> tau_F;  ///< torque about F's origin, less what the motor takes from the frame [N m]
  Vec3<T> h_F;    ///< J_i W_i a_i [kg m^2/s]
};

/// \param reaction_F  torque of the rotor on the frame [N m]
/// \param q           torque of the joint [N m]
template <class T>
QUADCORE_LAW RotorShare<T> rotor_share(const Vec3<T>& axis_F, const Vec3<T>& p_FRcm_F, T moment,
                                       T rate, const Vec3<T>& f_F, const Vec3<T>& reaction_F, T q) {
  return {f_F, cross(p_FRcm_F, f_F) - q * axis_F + reaction_F, (moment * rate) * axis_F};
}

/// dw/dt of the frame, in F [rad/s^2].
/// \param tau_C_F    torque about C, less the motors' [N m]
/// \param h_F        sum of the rotors' J_i W_i a_i
/// \param inverse_reduced_I_F  of I_C - sum J_i a_i a_i^T
template <class T, class I>
QUADCORE_LAW Vec3<T> angular_acceleration(const Vec3<T>& w_WF_F, const Vec3<T>& tau_C_F,
                                          const Vec3<T>& h_F, const Matrix3<I>& I_C_F,
                                          const Matrix3<I>& inverse_reduced_I_F) {
  return inverse_reduced_I_F * (tau_C_F - cross(w_WF_F, I_C_F * w_WF_F + h_F));
}

/// Rate of a quaternion (x, y, z, w) of a frame that turns at w_F, in its own axes [rad/s].
template <class T>
QUADCORE_LAW void quaternion_rate(const T* q, const Vec3<T>& w_F, T* rate) {
  rate[0] = 0.5 * (q[3] * w_F.x + q[1] * w_F.z - q[2] * w_F.y);
  rate[1] = 0.5 * (q[3] * w_F.y + q[2] * w_F.x - q[0] * w_F.z);
  rate[2] = 0.5 * (q[3] * w_F.z + q[0] * w_F.y - q[1] * w_F.x);
  rate[3] = -0.5 * (q[0] * w_F.x + q[1] * w_F.y + q[2] * w_F.z);
}

}  // namespace quadcore::laws
