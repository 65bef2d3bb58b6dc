#pragma once

#include <cmath>

#include "rotor_disc.hpp"

namespace quadcore::aerodynamic {

/// Thrust, thesis eq. (2.10): T = k w^2 along the disc's normal, at the rotor's centre of mass.
/// \param k  rotorThrustCoeff [N s^2/rad^2]
/// \return   force on the rotor in F [N]
inline Vector3d thrust(const RotorDisc& disc, double k) {
  return k * disc.speed * disc.speed * disc.axis_F;
}

/// Reaction torque, thesis eq. (2.11) without its inertial part (the engine has that): b w^2 with
/// the sign of the spin, as the thesis has it; real air drags the frame the other way (sign -1).
/// \param b     rotorTorqueCoeff [N m s^2/rad^2]
/// \param sign  +1 thesis, -1 opposing
/// \return      torque about the axis it acts on, on the frame [N m]
inline double reaction(const RotorDisc& disc, double b, double sign) {
  return sign * std::copysign(b * disc.speed * disc.speed, disc.speed);
}

}  // namespace quadcore::aerodynamic
