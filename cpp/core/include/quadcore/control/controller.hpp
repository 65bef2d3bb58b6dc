#pragma once

#include "quadcore/control/law.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A law down to the speeds of the rotors: the law, the allocation, and, by parameter `lead`, an
/// inversion of the motors' lag. Immutable; its state is numbers of its caller, all zero at the
/// beginning.
class Controller {
 public:
  /// Throws InputError on an unknown law or parameter, on a vehicle that it cannot fly.
  Controller(const std::string& law, const VehicleDescription& vehicle, const Values& values,
             const std::vector<double>& spins = {});

  /// Parameters of a law: its own, those of the motors' lead and of the belief.
  static std::vector<TagSpec> table(const std::string& law);
  /// Numbers of state of a law for so many rotors.
  static std::size_t state_size(const std::string& law, std::size_t rotors) {
    return kRotors + rotors + law_info(law).memory_size;
  }

  std::size_t rotors() const { return belief_.rotors.size(); }
  /// Speeds to command until the next call.
  /// \param period  since the last call and until the next [s]
  /// \param speeds  (rotors(),) signed [rad/s]
  void command(double period, const Odometry& now, const Reference& wanted, double* state,
               double* speeds) const;
  /// Whether the rotors could not do what was asked of them last.
  static bool saturated(const double* state) { return state[kSaturated] != 0; }

  const Belief& belief() const { return belief_; }

 private:
  /// State: whether it has begun, whether the last demand was not met, believed speeds of the
  /// rotors (without sign), then the law's.
  enum : std::size_t { kBegun, kSaturated, kRotors };

  Controller(const LawInfo& law, const VehicleDescription& vehicle, const Values& values,
             const std::vector<double>& spins);
  static Values completed_for(const std::string& law, const Values& values);
  bool lead(double period, bool begins, double* believed, double* speeds) const;

  Belief belief_;
  Allocation allocation_;
  std::unique_ptr<const Law> law_;
  bool leads_;
  double lead_time_;
};

}  // namespace control
}  // namespace quadcore
