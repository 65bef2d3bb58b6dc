#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

constexpr int not_driven = -1;  ///< place of a joint without a command

/// A rotor with its geometry and the combined effect of all plugins' force laws.
struct RotorDescription {
  std::string joint;  ///< name of the joint
  Vector3d p_FR_F;    ///< origin of the rotor's link [m]
  Vector3d p_FRcm_F;  ///< centre of mass of the rotor [m]
  Vector3d axis_F;    ///< unit vector; the right-hand rule gives the direction of a positive rate
  double moment;      ///< moment of inertia about the axis [kg m^2]
  /// Force and torque about the vehicle's centre of mass per squared joint rate, for a positive
  /// rate [N s^2/rad^2, N m s^2/rad^2].
  Wrench forward, backward;  ///< for a negative rate
  /// Speed of the rotor in its force laws divided by the joint's; 0 if no plugin sets it, in which
  /// case the description of a vehicle contains 1/|rate_per_command|.
  double slowdown = 0;
  /// Radius of the rotor's disc [m]; NaN if no plugin sets it.
  double radius = std::numeric_limits<double>::quiet_NaN();
  /// \name Set by the plugin that drives the rotor, see Plugin::describe_rotors()
  /// @{
  double rate_per_command = 1;  ///< steady-state joint rate per commanded speed
  /// Time constant with which the joint follows [s]; NaN if unknown.
  double lag = std::numeric_limits<double>::quiet_NaN();
  double fastest =
      std::numeric_limits<double>::infinity();  ///< maximum command that the motor follows [rad/s]
  int place = not_driven;                       ///< index in the command, counted from 0
  double spin = 0;          ///< only direction of rotation about the axis, 1 or -1; 0: both
  bool prescribed = false;  ///< driven by Loads::prescribe_joint_rate(), not by torques
  bool otherwise = false;   ///< driven by a command other than a speed: an angle or a torque
  /// @}
};

/// Resistance of still air to the moving vehicle with its rotors at hover speed, averaged over
/// their angles and both directions of rotation.
struct AirResistance {
  /// Maps the velocity of the centre of mass [m/s], stacked on the angular velocity [rad/s], to the
  /// opposing force [N], stacked on the torque about the centre of mass [N m]; all in F.
  Eigen::Matrix<double, 6, 6> linear = Eigen::Matrix<double, 6, 6>::Zero();
  /// Coefficient of the force that opposes v, proportional to |v| v [N s^2/m^2].
  double quadratic = 0;
  /// Coefficients of the force in F with component i opposing |v_i| v_i of the velocity in W, as in
  /// thesis appendix A.5 [N s^2/m^2].
  Vector3d of_components = Vector3d::Zero();
};

/// The vehicle as its engine simulates it, including bodies attached at the start. Controllers use
/// it as their model.
struct VehicleDescription {
  MassProperties body;                   ///< mass and inertia of the whole vehicle
  Vector3d gravity_W;                    ///< m/s^2
  std::vector<RotorDescription> rotors;  ///< all joints, in file order
  AirResistance air;                     ///< resistance of still air

  /// Return the indices of the rotors that follow the command, in the order of the command.
  std::vector<std::size_t> commanded() const;
  /// Return the same indices. Throws InputError unless each number of the command drives exactly
  /// one rotor.
  std::vector<std::size_t> driven() const;
};

}  // namespace quadcore
