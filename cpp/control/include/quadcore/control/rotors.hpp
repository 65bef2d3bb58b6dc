#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A rotor in the numbers that controllers and studies need, measured on the force laws of all
/// plugins, whatever their tags are called. "Speed" is that of a command, before the division by
/// `slowdown`: the size of the joint's rate times `slowdown`.
struct Rotor {
  std::string joint;  ///< its name
  Vector3d p_FR_F;    ///< origin of its link [m]
  Vector3d axis_F;    ///< unit; a positive rate turns about it by the right-hand rule
  double spin;        ///< sense about the axis in which it turns in a hover: 1, -1; 0: unknown
  double thrust_coefficient;  ///< force along the axis per squared speed [N s^2/rad^2]
  /// Size of the air's torque about the axis per squared speed [N m s^2/rad^2].
  double torque_coefficient;
  /// Sense of that torque on the frame: 1 along the spin, as thesis eq. (2.11) has it, -1 against
  /// it, as in nature, 0 if there is none.
  double torque_sense;
  double slowdown;          ///< speed over the joint's rate
  double rate_per_command;  ///< joint rate in the long run per commanded speed
  double time_constant;     ///< with which it follows a command [s]; NaN if unknown
  double max_speed;         ///< fastest command that is followed [rad/s]; infinite without a limit
  int place;                ///< of its number in the command, from 0 on, or not_driven
};

/// Lists every joint of a vehicle, in file order. Where the spin is unknown, thrust and torque are
/// those of a positive rate.
std::vector<Rotor> list_rotors(const VehicleDescription& vehicle);

/// Finds the sense, 1 or -1, in which each of these joints turns about its axis in a hover: as the
/// plugin that drives it says, or else neighbours around the vehicle turn against each other, in
/// that of the two ways in which they yaw it more, or else the first positively. Returns none if
/// neither is possible.
std::vector<double> find_spins(const VehicleDescription& vehicle,
                               const std::vector<std::size_t>& joints);

/// Returns what a rotor exerts per squared joint rate when it turns with a spin.
inline const Wrench& wrench_of(const RotorDescription& rotor, double spin) {
  return spin < 0 ? rotor.backward : rotor.forward;
}

}  // namespace control
}  // namespace quadcore
