#pragma once

#include <tuple>
#include <vector>

#include "command_block.hpp"

namespace quadcore::control {

/// A control law for the lanes.
struct LaneLaw {
  LawKind kind;
  LawSwitches switches;
  std::vector<double> numbers;  ///< see CommandBlock::law
};

/// A controller for the lanes.
struct LaneController {
  LaneLaw law;
  std::size_t rotors;
  std::vector<double> actuators;  ///< see CommandBlock::actuators
  std::vector<double> state;      ///< at the start, see Controller
};

/// Return whether two controllers can share a CommandBlock.
inline bool are_alike(const LaneController& a, const LaneController& b) {
  const auto listed = [](const LaneController& controller) {
    const LawSwitches& s = controller.law.switches;
    return std::make_tuple(controller.law.kind, controller.rotors, s.feed_forward, s.flat_rates,
                           s.integral, s.drag, s.gyroscopic);
  };
  return listed(a) == listed(b);
}

}  // namespace quadcore::control
