#pragma once

#include <cstddef>
#include <cstdint>

/// \file
/// Force laws as plain numbers and tables with a column for each rotor, in the layout of
/// rotor_layout.hpp. They can be evaluated for several rotors at once with the formulas in
/// cpp/physics/laws. Contains neither Eigen nor code, so that files compiled for a specific
/// processor can include it.

namespace quadcore {

/// Conventions of all rotor force laws.
struct RotorConventions {
  bool across_link_z;  ///< discs are perpendicular to their links' z instead of the joints' axes
  bool at_origins;     ///< discs move like their links' origins instead of the centres of mass
  bool meets_wind;     ///< wind acts on the discs
  bool about_frame_z;  ///< reaction torques act about the frame's z for any orientation of the
                       ///< rotors
  bool on_rotor;       ///< reaction torques act on the rotors about the joints' axes
};

/// Thrust, reaction torque, drag and flapping of the rotors.
struct RotorForces {
  RotorConventions conventions;  ///< conventions of all rotors
  std::uint32_t acting;  ///< a bit for each law of laws/rotor_laws.hpp, starting with the lowest
  double sim_slow;       ///< speed of a real rotor divided by the rate of its joint
  const double* coefficients;  ///< table of the laws' rows; 0 for rotors of other plugins
  const double* shares;        ///< remaining fraction of each rotor's thrust and reaction torque
};

/// Parasitic drag of the airframe at the vehicle's centre of mass.
struct FrameDrag {
  double coefficient;  ///< N s^2/m^2
};

/// Rows of the airframe's other laws, see laws/airframe.hpp: linear drag along z [N s/m], quadratic
/// drag along each axis [N s^2/m^2], hub moment [N s], damping of each rate [N m s], and constant
/// torque [N m].
struct AirframeRow {
  enum : std::size_t { axial, quadratic, hub_moment = 4, damping, torque = 8, count = 11 };
};

/// The airframe's other laws.
struct AirframeLaws {
  const double* coefficients;  ///< AirframeRow::count numbers
};

/// Rows of the motor controllers' memory; all 0 for rotors of other plugins and before the first
/// command. `active` is the remaining fraction of the torque, `target` the wanted joint rate
/// [rad/s], `error_sum` the integral of the rate error [rad], and `last_error` the last rate error
/// [rad/s]. `sampled_torque` is the torque of integral and derivative [N m], and `followed` the
/// number of the command that gave the target, or -1 after a timeout.
struct MemoryRow {
  enum : std::size_t { active, target, error_sum, last_error, sampled_torque, followed, count };
};

/// The continuous part of the motor torque: -kp (W - W_target) plus the torque sampled at the start
/// of the step (thesis appendix A.4), in slowed-down units [N m].
struct MotorTorques {
  const double* memory;  ///< table of MemoryRow
  double kp;             ///< N m s/rad
  /// Maximum command that the motor follows [rad/s].
  double fastest, sim_slow;  ///< divisor of the command
  const int* places;         ///< index of each rotor in the command, or not_driven
};

}  // namespace quadcore
