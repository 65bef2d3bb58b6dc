#pragma once

#include "quadcore/lane_laws.hpp"
#include "rotor_disc.hpp"

namespace quadcore::laws {

/// Blade flapping, thesis eq. (2.25) as corrected: F = T/|w| (A V_p + B nu) at the rotor's centre
/// of mass, in the body's non-spinning axes, with T/|w| = k |w|, s = sign(w) and
///   A = 1/r [-A1c  s A1s; -s A1s  -A1c],   B = [-s B2  B1; -B1  -s B2].
/// Both matrices commute with a turn about the axis a, so that A V = (-A1c V - s A1s a x V)/r and
/// B nu = -s B2 nu - B1 a x nu for the in-plane V and nu: no axes need to be chosen.
/// \param w_WF_F  nu, angular velocity of the frame [rad/s]
/// \param k       rotorThrustCoeff [N s^2/rad^2]
/// \param c       as Flapping has them
/// \return        force on the rotor in F [N]
template <class T, class K, class Coefficients>
QUADCORE_LAW Vec3<T> flapping(const RotorDisc<T>& disc, const Vec3<T>& w_WF_F, K k,
                              const Coefficients& c) {
  const T s = with_sign_of(disc.speed, broadcast<T>(1));
  const Vec3<T> nu_F = across(disc.axis_F, w_WF_F);
  const Vec3<T> A_V_r = -c.A1c * disc.V_F - (s * c.A1s) * cross(disc.axis_F, disc.V_F);
  const Vec3<T> B_nu = (-s * c.B2) * nu_F - c.B1 * cross(disc.axis_F, nu_F);
  return (k * absolute(disc.speed)) * ((1 / c.radius) * A_V_r + B_nu);
}

}  // namespace quadcore::laws
