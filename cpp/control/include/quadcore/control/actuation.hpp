#pragma once

#include "quadcore/control/allocation.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Converts a demand into rotor speeds: the allocation and, with parameter `lead`, a compensation
/// of the motors' lag. Immutable; the caller owns the state, which is all zero at the start.
class Actuation {
 public:
  /// Throws InputError if the rotors cannot produce thrust and all torques.
  Actuation(const ModelledVehicle& model, const Values& values);

  /// Return the parameters of the lag compensation.
  static const std::vector<TagSpec>& table();
  /// Return the number of state values for so many rotors.
  static std::size_t state_size(std::size_t rotors);

  /// Modelled state of the rotors.
  struct Now {
    bool begins;     ///< no demand has been given yet
    bool saturated;  ///< the last demand could not be met
    Demand exerted;  ///< wrench of the rotors
    Vector3d h_F;    ///< angular momentum of the rotors, relative to the frame [kg m^2/s]
  };
  /// Return the modelled state of the rotors after the commands so far.
  Now now(const double* state) const;
  /// Return whether the last demand could not be met.
  static bool saturated(const double* state);
  /// Return whether a demand has been given.
  static bool has_begun(const double* state);
  /// Return whether no rotor has lost thrust or torque.
  bool are_whole(const double* state) const;

  /// Set the remaining fraction of a rotor's thrust and torque.
  void set_remaining(std::size_t rotor, double left, double* state) const;
  /// Return whether the remaining rotors can yaw the vehicle in both directions at this thrust [N].
  bool can_control_yaw(double thrust, const double* state) const;

  /// Return the numbers of the rotors for the lanes, see CommandBlock::actuators.
  std::vector<double> list_numbers() const;
  /// Set the fractions of a change within a period, which the state contains.
  void set_period(double period, double* state) const;
  /// Compute the speeds to command until the next call.
  /// \param period  time since the last call and until the next [s]
  /// \param speeds  (rotors,) signed [rad/s]
  void command(double period, const Demand& demand, double* state, double* speeds) const;

 private:
  struct Numbers;

  const double* lost(const double* state) const;
  bool lead(double period, double* state, double* speeds) const;

  Allocation allocation_;
  std::shared_ptr<const Numbers> numbers_;
};

}  // namespace control
}  // namespace quadcore
