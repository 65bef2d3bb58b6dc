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
  static std::size_t state_size(std::size_t rotors) { return kRotors + 3 * rotors; }

  /// Modelled state of the rotors.
  struct Now {
    bool begins;     ///< no demand has been given yet
    bool saturated;  ///< the last demand could not be met
    Demand exerted;  ///< wrench of the rotors
    Vector3d h_F;    ///< angular momentum of the rotors, relative to the frame [kg m^2/s]
  };
  /// Return the modelled state of the rotors after the commands so far.
  /// \param scratch  one number for each rotor
  Now now(const double* state, double* scratch) const;
  /// Return whether the last demand could not be met.
  static bool saturated(const double* state) { return state[kSaturated] != 0; }

  /// Set the remaining fraction of a rotor's thrust and torque.
  void set_remaining(std::size_t rotor, double left, double* state) const {
    state[kRotors + rotors_.size() + rotor] = 1 - left;
  }
  /// Return whether the remaining rotors can yaw the vehicle in both directions at this thrust [N].
  bool can_control_yaw(double thrust, const double* state) const;

  /// Compute the speeds to command until the next call.
  /// \param period  time since the last call and until the next [s]
  /// \param speeds  (rotors,) signed [rad/s]
  void command(double period, const Demand& demand, double* state, double* speeds) const;

 private:
  /// State: whether it has begun, whether the last demand was not met, the period of the following
  /// fractions, the wanted fraction of a change within it; then the modelled rotor speeds (without
  /// sign), the lost fractions, and the fraction of a change of each rotor.
  enum : std::size_t { kBegun, kSaturated, kPeriod, kWantedShare, kRotors };

  const double* lost(const double* state) const { return state + kRotors + rotors_.size(); }
  void find_shares(double period, double* state) const;
  bool lead(double period, bool begins, double* state, double* speeds) const;

  std::vector<ModelledRotor> rotors_;
  Allocation allocation_;
  bool leads_;
  double lead_time_;
};

}  // namespace control
}  // namespace quadcore
