#pragma once

#include <cstddef>
#include <cstdint>

#include "controller_numbers.hpp"

/// \file
/// Controllers of several vehicles at once. Contains neither Eigen nor code, so that files compiled
/// for a specific processor can include it.

namespace quadcore::control {

/// Controllers for the lanes.
enum class ControllerKind { cascade, geometric, indi, lqr };

/// Number of values of a struct of numbers.
template <template <class> class Numbers>
constexpr std::size_t size_of = sizeof(Numbers<double>) / sizeof(double);

/// Controllers of vehicles. A table contains a struct of packs of W vehicles,
/// then that of the next W vehicles.
struct CommandBlock {
  ControllerKind kind;
  ControllerSwitches switches;
  std::size_t vehicles;
  std::size_t rotors, number_rows, state_rows;
  double period;
  bool begins;
  const double* numbers;    ///< CascadeNumbers, TrackingNumbers, IndiNumbers or LqrNumbers
  const double* actuators;  ///< RotorNumbers of each rotor
  const double* measured;   ///< MeasuredNumbers
  const double* wanted;     ///< WantedNumbers
  double* state;            ///< state of Controller
  double* demand;           ///< written DemandNumbers
  double* speeds;           ///< written commands of each rotor [rad/s]
  /// Written: -1 for each vehicle whose command is complete; 0 where the demand exceeds a rotor's
  /// limits, such that Actuation must distribute it.
  std::int64_t* complete;
};

/// Call the controllers, W at once. The unused vehicles of the last pack are computed as well.
template <int W>
void command_block(const CommandBlock& block);

/// The same for a block of one vehicle, with the instructions of processors with W lanes.
template <int W>
void command_single(const CommandBlock& block);

}  // namespace quadcore::control
