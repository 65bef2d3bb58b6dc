#pragma once

#include <tuple>
#include <vector>

#include "command_block.hpp"

namespace quadcore::control {

/// A WrenchController for the lanes.
struct LaneWrenchController {
  ControllerKind kind;
  ControllerSwitches switches;
  std::vector<double> numbers;  ///< see CommandBlock::numbers
};

/// A controller for the lanes.
struct LaneController {
  LaneWrenchController wrench_controller;
  std::size_t rotors;
  std::vector<double> actuators;  ///< see CommandBlock::actuators
  std::vector<double> state;      ///< at the start, see Controller
};

/// Return whether two controllers can share a CommandBlock.
inline bool are_alike(const LaneController& a, const LaneController& b) {
  const auto listed = [](const LaneController& controller) {
    const ControllerSwitches& s = controller.wrench_controller.switches;
    return std::make_tuple(controller.wrench_controller.kind, controller.rotors, s.feed_forward,
                           s.flat_rates, s.integral, s.drag, s.gyroscopic);
  };
  return listed(a) == listed(b);
}

}  // namespace quadcore::control
