#pragma once

#include "lanes/vec3.hpp"
#include "quadcore/lane_laws.hpp"
#include "rotor_law.hpp"

/// \file
/// Loads of the air on the airframe apart from its parasitic drag, in the frame's axes F:
///   f_F   = -c V_z e_z - q * |V| * V              at the vehicle's centre of mass [N],
///   tau_F = tau_0 - h e_z x V - d * w             [N m],
/// where V is the velocity of the vehicle's centre of mass relative to the air, w the frame's
/// angular velocity, and products of vectors and |V| are taken component by component. The hub
/// moment h e_z x V is the torque in proportion to velocity of rotors in oblique flow: the
/// advancing blades lift more, and induced drag acts above the centre of mass (G. M. Hoffmann et
/// al., "Quadrotor helicopter flight dynamics and control", AIAA 2007-6461, section III.B).

namespace quadcore::laws {

/// Coefficients of the airframe's laws in the order of AirframeRow.
struct Airframe {
  static constexpr Tag tags[] = {
      {"axialDragCoeff", "N s/m", "0", "drag of the airframe along its z axis, linear", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"bodyDragXCoeff", "N s^2/m^2", "0", "drag of the airframe along its x axis, quadratic", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"bodyDragYCoeff", "N s^2/m^2", "0", "drag of the airframe along its y axis, quadratic", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"bodyDragZCoeff", "N s^2/m^2", "0", "drag of the airframe along its z axis, quadratic", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"hubMomentCoeff", "N s", "0",
       "torque on the frame by its velocity: the moment -h e_z x V tilts the vehicle against its "
       "motion",
       "", Tag::Scales::drag},
      {"rollDampingCoeff", "N m s", "0", "torque of the air against the roll rate", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"pitchDampingCoeff", "N m s", "0", "torque of the air against the pitch rate", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"yawDampingCoeff", "N m s", "0", "torque of the air against the yaw rate", "",
       Tag::Scales::drag, Tag::at_least_zero},
      {"constantTorqueX", "N m", "0", "constant torque on the frame about x, such as bad trim", ""},
      {"constantTorqueY", "N m", "0", "constant torque on the frame about y, such as bad trim", ""},
      {"constantTorqueZ", "N m", "0", "constant torque on the frame about z, such as bad trim", ""},
  };
  static_assert(sizeof tags / sizeof *tags == AirframeRow::count);
};

/// Return the force on the airframe at the vehicle's centre of mass.
/// \param k  AirframeRow -> coefficient
template <class T, class Coefficient>
QUADCORE_LAW Vec3<T> airframe_force(const Coefficient& k, const Vec3<T>& V_F) {
  const T axial = k(AirframeRow::axial) + k(AirframeRow::quadratic + 2) * absolute(V_F.z);
  return {-k(AirframeRow::quadratic) * absolute(V_F.x) * V_F.x,
          -k(AirframeRow::quadratic + 1) * absolute(V_F.y) * V_F.y, -axial * V_F.z};
}

/// Return the torque on the frame.
template <class T, class Coefficient>
QUADCORE_LAW Vec3<T> airframe_torque(const Coefficient& k, const Vec3<T>& V_F,
                                     const Vec3<T>& w_WF_F) {
  const T h = k(AirframeRow::hub_moment);
  return {k(AirframeRow::torque) + h * V_F.y - k(AirframeRow::damping) * w_WF_F.x,
          k(AirframeRow::torque + 1) - h * V_F.x - k(AirframeRow::damping + 1) * w_WF_F.y,
          k(AirframeRow::torque + 2) - k(AirframeRow::damping + 2) * w_WF_F.z};
}

}  // namespace quadcore::laws
