#pragma once

#include "quadcore/control/wrench_controller.hpp"

namespace quadcore::control {

/// Outputs of a firmware's cascade, in the unit of its motor commands.
struct MotorOutputs {
  double thrust;            ///< command of every motor
  double roll, pitch, yaw;  ///< change of the commands for a positive torque about each axis
};

/// Mixes outputs to motor commands, and returns the thrust and torques of these commands. The roll
/// output acts on each motor in proportion to its distance from the roll axis, relative to the
/// maximum distance of a rotor from the centre of mass. The pitch output acts likewise. If the
/// highest command exceeds the maximum, all commands are reduced by the excess, and then negative
/// ones become zero.
class MotorMix {
 public:
  /// \param hover     command of every motor at which the modelled vehicle hovers
  /// \param full      maximum command
  /// \param exponent  thrust of a rotor ~ command^exponent; 1 or 2
  /// Throws InputError if a rotor does not push along z of F.
  MotorMix(const ModelledVehicle& model, double hover, double full, int exponent);

  /// Return the thrust and torques of the rotors.
  Demand demand(const MotorOutputs& outputs) const;

 private:
  double hover_, full_;
  int exponent_;
  double share_;  ///< thrust of each rotor in hover [N]
  /// Force along z [N] and torques [N m] of each rotor per thrust.
  Eigen::Matrix4Xd effect_;
  Eigen::Matrix3Xd weights_;  ///< change of each command per roll, pitch and yaw output
};

}  // namespace quadcore::control
