#pragma once

#include <vector>

#include "quadcore/control/controller.hpp"
#include "quadcore/plugin/topics.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// What control laws are told of the rotors: on a topic, of each joint of the vehicle that flies,
/// in the order of its file, the share of what its rotor exerts that is left.
class RotorHealth {
 public:
  /// Throws InputError where VehicleDescription::driven() does.
  explicit RotorHealth(const VehicleDescription& flown);

  /// Tells a controller what was published last, if anything was. Throws FlightError on a share
  /// that is none.
  void tell(const Topic& health, double time, const Controller& controller, double* state) const;

 private:
  std::vector<std::size_t> joints_;  ///< that are driven, in the order of the command
};

}  // namespace control
}  // namespace quadcore
