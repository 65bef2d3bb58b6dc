#pragma once

#include <cmath>

#include "rotor_disc.hpp"

namespace quadcore::aerodynamic {

/// Blade flapping coefficients, thesis eqs. (2.26), (2.27).
struct Flapping {
  double A1c = 0;     ///< rad
  double A1s = 0;     ///< rad
  double B1 = 0;      ///< s/rad
  double B2 = 0;      ///< s/rad
  double radius = 0;  ///< r, rotor radius [m]
};

/// Blade flapping, thesis eq. (2.25) as corrected: F = T/|w| (A V_p + B nu) at the rotor's centre
/// of mass, in the body's non-spinning axes, with T/|w| = k |w|, s = sign(w) and
///   A = 1/r [-A1c  s A1s; -s A1s  -A1c],   B = [-s B2  B1; -B1  -s B2].
/// Both matrices commute with a turn about the axis a, so that A V = (-A1c V - s A1s a x V)/r and
/// B nu = -s B2 nu - B1 a x nu for the in-plane V and nu: no axes need to be chosen.
/// \param w_WF_F  nu, angular velocity of the frame [rad/s]
/// \param k       rotorThrustCoeff [N s^2/rad^2]
/// \return        force on the rotor in F [N]
inline Vector3d flapping(const RotorDisc& disc, const Vector3d& w_WF_F, double k,
                         const Flapping& c) {
  const double s = disc.speed < 0 ? -1 : 1;
  const Vector3d nu_F = disc.in_plane(w_WF_F);
  const Vector3d A_V = (-c.A1c * disc.V_F - s * c.A1s * disc.axis_F.cross(disc.V_F)) / c.radius;
  const Vector3d B_nu = -s * c.B2 * nu_F - c.B1 * disc.axis_F.cross(nu_F);
  return k * std::abs(disc.speed) * (A_V + B_nu);
}

}  // namespace quadcore::aerodynamic
