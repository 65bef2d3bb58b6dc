#pragma once

#include <cstdint>

/// \file
/// Measured odometry of a block. Contains neither Eigen nor code, so that files compiled for a
/// specific processor can include it.

namespace quadcore::batch {

/// Quantities of odometry, in the order of OdometryErrors.
constexpr int measured_quantities = 4;

/// Errors of each quantity, see VectorErrors.
template <class T>
struct ErrorNumbers {
  T noise[measured_quantities], resolution[measured_quantities];
};

/// Sensors of the vehicles of a block.
struct MeasureBlock {
  const double* shown;                                                    ///< rows of StateRow
  bool is_noisy[measured_quantities], is_quantised[measured_quantities];  ///< of all vehicles
  const double* errors;         ///< table of ErrorNumbers, see control::CommandBlock
  const std::uint64_t* seeds;   ///< seed of each vehicle
  const std::uint64_t* begins;  ///< random numbers before the measurement at the start, of each
  std::uint64_t count;          ///< random numbers of each vehicle from then to this measurement
  double* measured;             ///< written table of control::MeasuredNumbers
};

/// Measure the odometry of all vehicles of a block, W at once.
template <int W>
void measure_block(const MeasureBlock& block);

}  // namespace quadcore::batch
