#pragma once

#include "lanes/four.hpp"

namespace quadcore::laws {

/// A rigid body with n axisymmetric rotors on continuous joints, in reduced coordinates. Because
/// each rotor's centre of mass lies on its axis and its inertia is symmetric about it, the mass
/// distribution does not change as the rotors turn. Notation: C the vehicle's centre of mass, w the
/// frame's rate, W_i the rate of joint i, a_i its axis, J_i the rotor's moment about it.
///
/// Angular momentum about C (e.g. Hughes, "Spacecraft Attitude Dynamics", ch. 6):
///   H = I_C w + sum J_i W_i a_i,   dH/dt + w x H = tau,
/// and for each rotor about its axis, with the torque q_i of its joint:
///   J_i (dW_i/dt + a_i . dw/dt) = q_i.
/// Eliminating dW_i/dt leaves (I_C - sum J_i a_i a_i^T) dw/dt = tau - w x H - sum q_i a_i.
/// \file

/// Return the torque of a rotor about C, without q_i a_i and w x J_i W_i a_i [N m].
/// \param p_CRcm_F    from C to the rotor's centre of mass [m]
/// \param f_F         force on it there [N]
/// \param reaction_F  torque of the rotor on the frame [N m]
/// \param q           torque of the joint [N m]
template <class T>
QUADCORE_LAW Vec3<T> rotor_torque(const Vec3<T>& w_WF_F, const Vec3<T>& axis_F,
                                  const Vec3<T>& p_CRcm_F, T moment, T rate, const Vec3<T>& f_F,
                                  const Vec3<T>& reaction_F, T q) {
  return (reaction_F - (q * axis_F + (moment * rate) * cross(w_WF_F, axis_F))) +
         cross(p_CRcm_F, f_F);
}

/// Return the rate of the quaternion of a frame with the angular velocity w_F in its own axes
/// [rad/s]: half the quaternion times (w_F, 0).
QUADCORE_LAW Four quaternion_rate(const Four& q, const Four& w_F) {
  const Columns product{negated<0, 0, 1, 1>(permuted<3, 2, 1, 0>(q)),
                        negated<1, 0, 0, 1>(permuted<2, 3, 0, 1>(q)),
                        negated<0, 1, 0, 1>(permuted<1, 0, 3, 2>(q))};
  return product * (0.5 * w_F);
}

}  // namespace quadcore::laws
