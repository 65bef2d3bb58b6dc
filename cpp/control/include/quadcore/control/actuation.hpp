#pragma once

#include "quadcore/control/allocation.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// From what is asked of the rotors down to their speeds: the allocation, and, by parameter `lead`,
/// an inversion of the motors' lag. Immutable; its state is numbers of its caller, all zero at the
/// beginning.
class Actuation {
 public:
  /// Throws InputError if the rotors cannot exert what may be asked of them.
  Actuation(const Belief& belief, const Values& values);

  /// Parameters of the motors' lead.
  static const std::vector<TagSpec>& table();
  /// Numbers of state for so many rotors.
  static std::size_t state_size(std::size_t rotors) { return kRotors + 2 * rotors; }

  /// What the rotors do, as is believed.
  struct Now {
    bool begins;     ///< nothing was asked of them yet
    bool saturated;  ///< they could not do what was asked of them last
    Demand exerted;  ///< by the rotors
    Vector3d h_F;    ///< their angular momentum, relative to the frame [kg m^2/s]
  };
  /// What they do now, as they follow what was commanded so far.
  /// \param scratch  one number for each rotor
  Now now(const double* state, double* scratch) const;
  /// Whether the rotors could not do what was asked of them last.
  static bool saturated(const double* state) { return state[kSaturated] != 0; }

  /// Of a rotor, the share of what it exerts that is left, as is known from now on.
  void know(std::size_t rotor, double left, double* state) const {
    state[kRotors + rotors_.size() + rotor] = 1 - left;
  }
  /// Whether what is known to be left of rotors that lift so much [N] turns the vehicle about z
  /// either way.
  bool keeps_yaw(double thrust, const double* state) const;

  /// Speeds to command until the next call.
  /// \param period  since the last call and until the next [s]
  /// \param speeds  (rotors,) signed [rad/s]
  void command(double period, const Demand& demand, double* state, double* speeds) const;

 private:
  /// State: whether it has begun, whether the last demand was not met, of the rotors the believed
  /// speeds (without sign), then the shares that are lost.
  enum : std::size_t { kBegun, kSaturated, kRotors };

  const double* lost(const double* state) const { return state + kRotors + rotors_.size(); }
  bool lead(double period, bool begins, double* state, double* speeds) const;

  std::vector<BelievedRotor> rotors_;
  Allocation allocation_;
  bool leads_;
  double lead_time_;
};

}  // namespace control
}  // namespace quadcore
