#pragma once

#include "quadcore/plugin/effect.hpp"
#include "rotor_disc.hpp"

/// \file
/// A rotor force law is a struct of its coefficients of type T, a number or a pack, with
///   term     name of the wrench that a log records,
///   tags     its parameters in the URDF,
///   effect   kind of load,
///   from(given)   coefficients of a rotor from the tags' values given.numbers(tags),
///   force(disc, motion) or torque(disc), depending on `effect`.
/// A law with only zero coefficients is skipped at no cost. RotorLaws lists the laws, and
/// everything else (steps, batches, logs, tag tables) is derived from that list.

namespace quadcore::laws {

/// A parameter of a law in the URDF. TagSpec describes the members; this struct contains no code.
struct Tag {
  enum Range { any, at_least_zero, above_zero };
  using Scales = quadcore::Effect;

  const char *name, *unit;
  const char* fallback;  ///< null if the tag is required
  const char *meaning, *equation;
  Scales scales = Scales::none;
  Range range = any;
  const char* compiled_in =
      nullptr;  ///< value compiled into the thesis' plugin (A.5) instead of a tag
};
/// Marks a required tag.
constexpr const char* required = nullptr;

/// Kind of load of a law.
enum class Effect {
  force,               ///< on the rotor at its centre of mass, in F [N]
  in_plane_drag,       ///< force of an InPlaneDrag, whose coefficients can be summed
  force_in_link_axes,  ///< force in the axes of the rotor's spinning link [N]
  reaction_torque      ///< torque of the rotor on the frame, about the disc's axis [N m]
};

}  // namespace quadcore::laws
