#pragma once

#include <vector>

#include "quadcore/control/controller.hpp"
#include "quadcore/plugin/topics.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Reads the remaining fraction of each rotor's thrust and torque from a topic, which lists all
/// joints of the simulated vehicle in file order.
class RotorHealth {
 public:
  /// Throws InputError like VehicleDescription::driven().
  explicit RotorHealth(const VehicleDescription& flown);

  /// Update a controller with the last message, if any. Throws FlightError for an invalid fraction.
  void update(const Topic& health, double time, const Controller& controller, double* state) const;

 private:
  std::vector<std::size_t> joints_;  ///< driven joints, in the order of the command
};

}  // namespace control
}  // namespace quadcore
