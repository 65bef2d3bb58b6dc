#pragma once

#include "block.hpp"

/// \file
/// Commands to the motors of a block. Contains neither Eigen nor code, so that files compiled for a
/// specific processor can include it.

namespace quadcore::batch {

/// Commands of vehicles of a block that take effect.
struct Commands {
  std::size_t width;          ///< numbers in the command of a vehicle
  const double* speeds;       ///< see control::CommandBlock::speeds
  const std::int64_t* takes;  ///< -1 for each vehicle that takes its command, else 0
  bool are_first;             ///< whether no others took effect before
  double* variation;          ///< table of laws::VariationRow, for each number of a command
  std::int64_t* are_finite;   ///< written: -1 for each vehicle whose numbers are finite, else 0
};

/// Set the targets of the motors and add the commands to their variation, W vehicles at once.
/// \param places  see LaneVehicle
template <int W>
void command_motors(const Block& block, const int* places, const Commands& commands);

}  // namespace quadcore::batch
