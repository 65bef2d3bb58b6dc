#pragma once

#include "rotor_disc.hpp"

namespace quadcore::laws {

/// Induced, translational and profile drag, thesis eqs. (2.28)-(2.30): each opposes the rotor's
/// velocity in its own plane, linearly (the second branch of (2.29) is left out, as in the thesis).
/// Acts at the rotor's centre of mass. The printed plus signs are a slip: drag opposes motion.
/// \param coefficient  K_I, K_T1 or K_P [N s/m]
/// \return             force on the rotor in F [N]
template <class T, class K>
QUADCORE_LAW Vec3<T> rotor_drag(const RotorDisc<T>& disc, K coefficient) {
  return -coefficient * disc.V_F;
}

/// Parasitic drag of the airframe, thesis eq. (2.31): -K |V| V at the vehicle's centre of mass, V
/// its velocity through the air.
/// \param speed        |V| [m/s]
/// \param coefficient  parasiticDragCoeff [N s^2/m^2]
/// \return     force on the frame in F [N]
template <class Vector, class K>
QUADCORE_LAW Vector parasitic_drag(const Vector& V_F, K speed, K coefficient) {
  return (-coefficient * speed) * V_F;
}

/// Parasitic drag as the thesis' plugin (appendix A.5) computes it: -K |v_i| v_i of each component
/// of the frame's WORLD velocity, taken as components in the propeller's own SPINNING axes, once
/// per propeller, at its centre of mass. Kept because the published results rest on it.
/// \param v_WF_W  velocity of the frame's origin in W [m/s]
/// \return        force on the rotor, in the spinning axes of its link [N]
template <class T, class C>
QUADCORE_LAW Vec3<T> parasitic_drag_of_appendix(const Vec3<T>& v_WF_W, C K) {
  return -K * Vec3<T>{absolute(v_WF_W.x) * v_WF_W.x, absolute(v_WF_W.y) * v_WF_W.y,
                      absolute(v_WF_W.z) * v_WF_W.z};
}

}  // namespace quadcore::laws
