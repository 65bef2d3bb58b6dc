#pragma once

#include "quadcore/plugin/effect.hpp"
#include "rotor_disc.hpp"

/// \file
/// What a law of rotors consists of: a struct of its coefficients, of type T, a number or a pack of
/// them, with
///   term     name of the wrench that a log records,
///   tags     what the URDF gives,
///   effect   what the law exerts,
///   from(given)   the coefficients of a rotor, where given.numbers(tags) are the tags' numbers,
///   force(disc, motion) or torque(disc), as `effect` says.
/// A law all of whose coefficients are zero does not act and costs nothing. RotorLaws lists the
/// laws, and everything else (steps, batches, logs, tag tables) follows that list.

namespace quadcore::laws {

/// A number that a law takes from the URDF. TagSpec describes the members; this one is free of
/// code.
struct Tag {
  enum Range { any, at_least_zero, above_zero };
  using Scales = quadcore::Effect;

  const char *name, *unit;
  const char* fallback;  ///< null if a model must have the tag
  const char *meaning, *equation;
  Scales scales = Scales::none;
  Range range = any;
  const char* compiled_in = nullptr;  ///< number that the thesis' plugin (A.5) has instead of a tag
};
/// In place of a default.
constexpr const char* required = nullptr;

/// What a law exerts.
enum class Effect {
  force,               ///< on the rotor at its centre of mass, in F [N]
  in_plane_drag,       ///< such a force of an InPlaneDrag, whose coefficients may be summed
  force_in_link_axes,  ///< such a force in the axes of the rotor's link, which spins [N]
  reaction_torque      ///< of the rotor on the frame, about the disc's axis [N m]
};

}  // namespace quadcore::laws
