#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Parameters of a rotor for controllers and studies, measured from the force laws of all plugins.
/// A speed is a commanded speed, before the division by `slowdown`: the joint's absolute rate times
/// `slowdown`.
struct Rotor {
  std::string joint;  ///< name of the joint
  Vector3d p_FR_F;    ///< origin of the rotor's link [m]
  Vector3d axis_F;    ///< unit vector; the right-hand rule gives the direction of a positive rate
  double spin;        ///< direction of rotation about the axis in hover: 1, -1; 0: unknown
  double thrust_coefficient;  ///< force along the axis per squared speed [N s^2/rad^2]
  /// Magnitude of the aerodynamic torque about the axis per squared speed [N m s^2/rad^2].
  double torque_coefficient;
  /// Direction of that torque on the frame: 1 along the spin (thesis eq. (2.11)), -1 opposing it
  /// (physical), 0 if there is none.
  double torque_sense;
  double slowdown;          ///< speed divided by the joint's rate
  double rate_per_command;  ///< steady-state joint rate per commanded speed
  double time_constant;     ///< time constant of the response to a command [s]; NaN if unknown
  double max_speed;  ///< maximum speed that the motor follows [rad/s]; infinite without a limit
  int place;         ///< index in the command, counted from 0, or not_driven
};

/// List all joints of a vehicle in file order. If the spin is unknown, thrust and torque refer to a
/// positive rate.
std::vector<Rotor> list_rotors(const VehicleDescription& vehicle);

/// Find the direction of rotation in hover, 1 or -1, of each of these joints. The plugin that
/// drives a joint may define it. Otherwise neighbours around the vehicle alternate, such that they
/// yaw the vehicle more strongly, or else the first turns positively. Returns nothing if neither is
/// possible.
std::vector<double> find_spins(const VehicleDescription& vehicle,
                               const std::vector<std::size_t>& joints);

/// Return the wrench of a rotor per squared joint rate for a direction of rotation.
inline const Wrench& wrench_of(const RotorDescription& rotor, double spin) {
  return spin < 0 ? rotor.backward : rotor.forward;
}

}  // namespace control
}  // namespace quadcore
