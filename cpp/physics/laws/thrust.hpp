#pragma once

#include "rotor_disc.hpp"

namespace quadcore::laws {

/// Thrust, thesis eq. (2.10): T = k w^2 along the disc's normal, at the rotor's centre of mass.
/// \param k  rotorThrustCoeff [N s^2/rad^2]
/// \return   force on the rotor in F [N]
template <class T, class K>
QUADCORE_LAW Vec3<T> thrust(const RotorDisc<T>& disc, K k) {
  return (k * disc.speed * disc.speed) * disc.axis_F;
}

/// Reaction torque, thesis eq. (2.11) without its inertial part (the engine has that): b w^2 with
/// the sign of the spin, as the thesis has it; real air drags the frame the other way (b < 0).
/// \param b  rotorTorqueCoeff [N m s^2/rad^2], negative for the opposing sign
/// \return   torque about the axis it acts on, on the frame [N m]
template <class T, class K>
QUADCORE_LAW T reaction(const RotorDisc<T>& disc, K b) {
  return b * disc.speed * absolute(disc.speed);
}

}  // namespace quadcore::laws
