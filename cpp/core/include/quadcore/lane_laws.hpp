#pragma once

#include <cstddef>
#include <cstdint>

/// \file
/// Force laws as numbers and tables of numbers, a column for each rotor, laid out as
/// rotor_layout.hpp says. Whoever has one may evaluate it for several rotors at once; the formulas
/// stand in cpp/physics/laws. Free of Eigen and of code, so that files compiled for one processor
/// may include it.

namespace quadcore {

/// How the laws of rotors act, whichever they are.
struct RotorConventions {
  bool across_link_z;  ///< discs stand across their links' z, or across the joints' axes
  bool at_origins;     ///< discs move as their links' origins, or as the centres of mass
  bool meets_wind;     ///< whether the discs meet the moving air, or air that stands still
  bool about_frame_z;  ///< reaction torques act so, however the rotors stand
  bool on_rotor;       ///< reaction torques act about the joints' axes on the rotors
};

/// Thrust, reaction torque, drag and flapping of the rotors.
struct RotorForces {
  RotorConventions conventions;  ///< of all rotors
  std::uint32_t acting;  ///< a bit for each law of laws/rotor_laws.hpp, the first one's lowest
  double sim_slow;       ///< speed of a real rotor over the rate of its joint
  const double* coefficients;  ///< table of the laws' rows; 0 for rotors that are somebody else's
  const double* shares;        ///< of each rotor, what is left of its thrust and reaction torque
};

/// Parasitic drag of the airframe at the vehicle's centre of mass.
struct FrameDrag {
  double coefficient;  ///< N s^2/m^2
};

/// Rows of what the rotors' controllers remember; all 0 for rotors that are somebody else's and
/// before the first command: `active`, the share of the torque that is left; `target` of the
/// joint's rate [rad/s]; `error_sum`, the integral of the rate's error [rad]; `last_error` [rad/s];
/// `sampled_torque` of integral and derivative [N m]; `followed`, the number of the command that
/// gave the target, -1 if none came in time.
struct MemoryRow {
  enum : std::size_t { active, target, error_sum, last_error, sampled_torque, followed, count };
};

/// The part of the motors' law that is continuous: -kp (W - W_target) and the torque sampled at the
/// start of the step (thesis appendix A.4), in slowed units [N m].
struct MotorTorques {
  const double* memory;  ///< table of MemoryRow
  double kp;             ///< N m s/rad
  /// Up to which a command is followed [rad/s].
  double fastest, sim_slow;  ///< by which it is divided then
  const int* places;         ///< of each rotor, its number in the command; not_driven for others
};

}  // namespace quadcore
