#pragma once

#include "quadcore/lane_laws.hpp"
#include "rotor_laws.hpp"
#include "rotors.hpp"

/// \file
/// Total loads of all force laws on a pack of rotors. The rotors belong to one vehicle, starting at
/// rotor i, or are rotor i of several vehicles. Their motion is in tables or registers: a Motion of
/// packs T has
///   rate(), axis_F(), normal_F(), velocity_F(bool of_origins)   as RotorKinematics,
///   in_frame(f_R)   a vector, given in the axes of the rotors' links, in the frame's,
///   windy(), v_WA_F(), w_WF_F(), v_WF_W()   air and frame.

namespace quadcore::laws {

/// Force laws of a pack of rotors.
template <class T>
struct LawsOfRotors {
  const RotorConventions& conventions;
  RotorLaws::Places acting;
  Table<T, widest_lanes> coefficients;  ///< rows of RotorLaws
  T share;                              ///< remaining fraction of thrust and reaction torque
  T sim_slow;
};

/// Return the laws of one vehicle, starting at rotor i.
template <class T>
QUADCORE_LAW LawsOfRotors<T> laws_of_rotors(const RotorForces& law, std::size_t i) {
  return {law.conventions,
          law.acting,
          {law.coefficients + rotor_offset(RotorLaws::rows, i)},
          load<T>(law.shares + i),
          broadcast<T>(law.sim_slow)};
}

template <class T, class Motion>
QUADCORE_LAW RotorDisc<T> disc_of(const LawsOfRotors<T>& laws, const Motion& motion) {
  const RotorConventions& conventions = laws.conventions;
  const Vec3<T> normal_F = conventions.across_link_z ? motion.normal_F() : motion.axis_F();
  Vec3<T> v_AR_F = motion.velocity_F(conventions.at_origins);
  if (conventions.meets_wind && motion.windy()) v_AR_F = v_AR_F - motion.v_WA_F();
  return {normal_F, motion.rate() * laws.sim_slow, laws.share, across(normal_F, v_AR_F)};
}

/// Return the force of a law in frame axes.
template <class T, class Law, class Motion>
QUADCORE_LAW Vec3<T> force_F(const Law& law, const RotorDisc<T>& disc, const Motion& motion) {
  if constexpr (Law::effect == Effect::force_in_link_axes) {
    return motion.in_frame(law.force(disc, motion));
  } else {
    return law.force(disc, motion);
  }
}

/// Loads on a pack of rotors, see LoadRow.
template <class T>
struct RotorLoads {
  Vec3<T> f_F, reaction_F;
  T joint_torque;
};

template <class T, class Motion>
QUADCORE_LAW void add_reaction(const RotorConventions& conventions, const RotorDisc<T>& disc,
                               const Motion& motion, T torque, RotorLoads<T>& loads) {
  if (conventions.about_frame_z) {
    loads.reaction_F.z = loads.reaction_F.z + torque;
  } else {
    loads.reaction_F =
        loads.reaction_F + torque * (conventions.on_rotor ? motion.axis_F() : disc.axis_F);
  }
  if (conventions.on_rotor) loads.joint_torque = loads.joint_torque + torque;
}

/// The laws that require the orientation of the links.
constexpr RotorLaws::Places in_link_axes = RotorLaws::with(Effect::force_in_link_axes);

/// Add the loads of the laws on a pack.
template <class T, class Motion>
QUADCORE_LAW void add_rotor_forces(const LawsOfRotors<T>& laws, const Motion& motion,
                                   RotorLoads<T>& loads) {
  RotorDisc<T> disc = disc_of(laws, motion);
  const auto add = [&](const auto& law, std::size_t) QUADCORE_INLINED {
    if constexpr (std::decay_t<decltype(law)>::effect == Effect::reaction_torque) {
      add_reaction(laws.conventions, disc, motion, law.torque(disc), loads);
    } else {
      loads.f_F = loads.f_F + force_F(law, disc, motion);
    }
  };
  RotorLaws::for_each(laws.acting & ~in_link_axes, laws.coefficients, add);
  // Last, because they depend on the orientation of the links.
  RotorLaws::for_each(laws.acting & in_link_axes, laws.coefficients, add);
}

}  // namespace quadcore::laws
