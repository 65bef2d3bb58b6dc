#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

constexpr int not_driven = -1;  ///< place of a joint that follows no command

/// A rotor as it stands in the frame, and what the force laws of all plugins make of it.
struct RotorDescription {
  std::string joint;  ///< its name
  Vector3d p_FR_F;    ///< origin of its link [m]
  Vector3d p_FRcm_F;  ///< its centre of mass [m]
  Vector3d axis_F;    ///< unit; a positive rate turns about it by the right-hand rule
  double moment;      ///< moment of inertia about the axis [kg m^2]
  /// Force and torque about the vehicle's centre of mass per squared joint rate, turning with a
  /// positive rate [N s^2/rad^2, N m s^2/rad^2].
  Wrench forward, backward;  ///< the same with a negative rate
  /// Speed of the rotor in its force laws over the joint's; 0 if no plugin says it. The description
  /// of a vehicle then has 1/|rate_per_command|.
  double slowdown = 0;
  /// \name As the plugin that drives it says, see Plugin::describe_rotors()
  /// @{
  double rate_per_command = 1;  ///< joint rate in the long run per commanded speed
  /// Time constant with which the joint follows [s]; NaN if unknown.
  double lag = std::numeric_limits<double>::quiet_NaN();
  double fastest = std::numeric_limits<double>::infinity();  ///< command that is followed [rad/s]
  int place = not_driven;   ///< of its number in the command, from 0 on
  double spin = 0;          ///< sense about its axis in which alone it is driven, 1, -1; 0: either
  bool prescribed = false;  ///< it turns as Loads::prescribe_joint_rate() says, not by torques
  bool otherwise = false;   ///< it is driven by a command that is no speed: an angle, a torque
  /// @}
};

/// What still air does to the vehicle that moves through it while its rotors turn as in a hover:
/// the mean over their angles and both senses.
struct AirResistance {
  /// Force [N] above torque about the centre of mass [N m], both in F and opposed to the velocity
  /// of the centre of mass [m/s] above the angular velocity [rad/s], both in F.
  Eigen::Matrix<double, 6, 6> linear = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of the force that opposes v with |v| v [N s^2/m^2].
  double quadratic = 0;
  /// Of the force in F whose i-th component opposes that of the velocity in W, v_i, with |v_i| v_i,
  /// as thesis appendix A.5 has it [N s^2/m^2].
  Vector3d of_components = Vector3d::Zero();
};

/// The vehicle as its engine flies it, with what it carries at the start: what a control law would
/// otherwise ask for as tags.
struct VehicleDescription {
  MassProperties body;                   ///< of the whole vehicle
  Vector3d gravity_W;                    ///< m/s^2
  std::vector<RotorDescription> rotors;  ///< every joint, in file order
  AirResistance air;                     ///< what still air does to it

  /// Those of `rotors` that follow the command, in the order of its numbers.
  std::vector<std::size_t> commanded() const;
  /// The same. Throws InputError unless each number of the command drives exactly one rotor.
  std::vector<std::size_t> driven() const;
};

}  // namespace quadcore
