#pragma once

#include "quadcore/control/actuation.hpp"
#include "quadcore/control/law.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A law down to the speeds of the rotors. Immutable; its state is numbers of its caller, all zero
/// at the beginning.
class Controller {
 public:
  /// Throws InputError on an unknown law or parameter, on a vehicle that it cannot fly.
  Controller(const std::string& law, const VehicleDescription& vehicle, const Values& values,
             const std::vector<double>& spins = {});

  /// Parameters of a law: its own, those of the motors' lead and of the belief.
  static std::vector<TagSpec> table(const std::string& law);
  /// Numbers of state of a law for so many rotors.
  static std::size_t state_size(const std::string& law, std::size_t rotors) {
    return Actuation::state_size(rotors) + law_info(law).memory_size;
  }

  /// How many rotors are driven.
  std::size_t rotors() const { return belief_.rotors.size(); }
  /// Speeds to command until the next call. Yaw is given up, and only its rate damped as far as may
  /// be, where what is left of the rotors cannot turn the hovering vehicle either way.
  /// \param period  since the last call and until the next [s]
  /// \param speeds  (rotors(),) signed [rad/s]
  void command(double period, const Odometry& now, const Reference& wanted, double* state,
               double* speeds) const;
  /// Of a rotor, the share of what it exerts that is left, as the allocation is told from now on.
  void know(std::size_t rotor, double left, double* state) const {
    actuation_.know(rotor, left, state);
  }
  /// Whether the rotors could not do what was asked of them last.
  static bool saturated(const double* state) { return Actuation::saturated(state); }

  /// What it believes of the vehicle.
  const Belief& belief() const { return belief_; }

 private:
  Controller(const LawInfo& law, const VehicleDescription& vehicle, const Values& values,
             const std::vector<double>& spins);
  static Values completed_for(const std::string& law, const Values& values);

  Belief belief_;
  Actuation actuation_;
  std::unique_ptr<const Law> law_;
};

}  // namespace control
}  // namespace quadcore
