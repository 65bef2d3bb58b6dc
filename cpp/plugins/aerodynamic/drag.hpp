#pragma once

#include "rotor_disc.hpp"

namespace quadcore::aerodynamic {

/// Induced, translational and profile drag, thesis eqs. (2.28)-(2.30): each opposes the rotor's
/// velocity in its own plane, linearly (the second branch of (2.29) is left out, as in the thesis).
/// Acts at the rotor's centre of mass. The printed plus signs are a slip: drag opposes motion.
/// \param coefficient  K_I, K_T1 or K_P [N s/m]
/// \return             force on the rotor in F [N]
inline Vector3d rotor_drag(const RotorDisc& disc, double coefficient) {
  return -coefficient * disc.V_F;
}

/// Parasitic drag of the airframe, thesis eq. (2.31): -K |V| V at the vehicle's centre of mass, V
/// its velocity through the air.
/// \param K  parasiticDragCoeff [N s^2/m^2]
/// \return   force on the frame in F [N]
inline Vector3d parasitic_drag(const Vector3d& v_F, double K) { return -K * v_F.norm() * v_F; }

/// Parasitic drag as the thesis' plugin (appendix A.5) computes it: -K |v_i| v_i of each component
/// of the frame's WORLD velocity, taken as components in the propeller's own SPINNING axes, once
/// per propeller, at its centre of mass. Kept because the published results rest on it.
/// \param v_WF_W  velocity of the frame's origin in W [m/s]
/// \param R_FR    orientation of the spinning propeller in F
/// \return        force on the rotor in F [N]
inline Vector3d parasitic_drag_of_appendix(const Vector3d& v_WF_W, const Matrix3d& R_FR, double K) {
  return R_FR * (-K * v_WF_W.cwiseAbs().cwiseProduct(v_WF_W));
}

}  // namespace quadcore::aerodynamic
