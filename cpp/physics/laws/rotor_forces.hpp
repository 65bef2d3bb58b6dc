#pragma once

#include "drag.hpp"
#include "flapping.hpp"
#include "quadcore/lane_laws.hpp"
#include "rotors.hpp"
#include "thrust.hpp"

/// \file
/// The forces of a pack of rotors: of one vehicle, from rotor i on, or the i-th of several
/// vehicles. Their motion may lie in tables or in registers: a Motion of packs T tells
///   rate(), axis_F(), normal_F(), velocity_F(bool of_origins)   as RotorKinematics says,
///   in_frame(f_R)   a vector, given in the axes of the rotors' links, in the frame's,
///   windy(), v_WA_F(), w_WF_F(), v_WF_W()   air and frame.
/// A Law is RotorForces, or has what that has, and a coefficient<T>(law, row, i) of its own.

namespace quadcore::laws {

template <class T>
QUADCORE_LAW T coefficient(const RotorForces& law, std::size_t row, std::size_t i) {
  return load<T>(law.coefficients + rotor_offset(CoefficientRow::count, i) + row * widest_lanes);
}

template <class T, class Law, class Motion>
QUADCORE_LAW RotorDisc<T> disc_of(const Law& law, const Motion& motion) {
  const Vec3<T> normal_F = law.across_link_z ? motion.normal_F() : motion.axis_F();
  Vec3<T> v_AR_F = motion.velocity_F(law.at_origins);
  if (law.meets_wind && motion.windy()) v_AR_F = v_AR_F - motion.v_WA_F();
  return {normal_F, motion.rate() * law.sim_slow, across(normal_F, v_AR_F)};
}

template <class T, class Law>
QUADCORE_LAW T reaction_of(const Law& law, const RotorDisc<T>& disc, std::size_t i) {
  return reaction(disc, coefficient<T>(law, CoefficientRow::b, i));
}

/// Unit, about which the reaction torque acts on the vehicle, unless it acts about the frame's z.
template <class T, class Law, class Motion>
QUADCORE_LAW Vec3<T> reaction_axis_F(const Law& law, const RotorDisc<T>& disc,
                                     const Motion& motion) {
  return law.on_rotor ? motion.axis_F() : disc.axis_F;
}

template <class T, class Law, class Motion>
QUADCORE_LAW Vec3<T> parasitic_F(const Law& law, const Motion& motion, std::size_t i) {
  return motion.in_frame(parasitic_drag_of_appendix(
      motion.v_WF_W(), coefficient<T>(law, CoefficientRow::parasitic, i)));
}

template <class T, class Law, class Motion>
QUADCORE_LAW Vec3<T> flapping_F(const Law& law, const RotorDisc<T>& disc, const Motion& motion,
                                std::size_t i) {
  return flapping(disc, motion.w_WF_F(), coefficient<T>(law, CoefficientRow::k, i), law.flapping);
}

/// What acts on a pack of rotors, as LoadRow says.
template <class T>
struct RotorLoads {
  Vec3<T> f_F, reaction_F;
  T joint_torque;
};

/// Adds what the law exerts on a pack.
template <class T, class Law, class Motion>
QUADCORE_LAW void add_rotor_forces(const Law& law, const Motion& motion, std::size_t i,
                                   RotorLoads<T>& loads) {
  RotorDisc<T> disc = disc_of<T>(law, motion);
  // The drag last, because it waits for the velocity.
  loads.f_F = loads.f_F + thrust(disc, coefficient<T>(law, CoefficientRow::k, i));
  loads.f_F = loads.f_F + rotor_drag(disc, coefficient<T>(law, CoefficientRow::linear, i));
  const T torque = reaction_of(law, disc, i);
  if (law.about_frame_z) {
    loads.reaction_F.z = loads.reaction_F.z + torque;
  } else {
    loads.reaction_F = loads.reaction_F + torque * reaction_axis_F(law, disc, motion);
  }
  if (law.on_rotor) loads.joint_torque = loads.joint_torque + torque;
  if (law.flaps) loads.f_F = loads.f_F + flapping_F<T>(law, disc, motion, i);
  if (law.parasitic) loads.f_F = loads.f_F + parasitic_F<T>(law, motion, i);
}

}  // namespace quadcore::laws
