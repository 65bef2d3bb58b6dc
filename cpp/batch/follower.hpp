#pragma once

#include <chrono>
#include <vector>

#include "block.hpp"
#include "quadcore/batch.hpp"
#include "quadcore/odometry_errors.hpp"
#include "quadcore/total_variation.hpp"

namespace quadcore::batch {

/// A vehicle of a block that follows a reference in the lanes.
struct Follower {
  std::size_t vehicle;
  const BatchGuide* guide;
  BatchGuided* guided;
  const OdometryErrors* errors;
  std::uint64_t seed;  ///< of the odometry
  double draws;        ///< random numbers before the measurement at the start
  TotalVariation commands;
  bool has_left = false;  ///< whether it has left the lanes; its results are then incomplete

  /// Speeds in effect at the end; empty before the first command.
  std::vector<double> speeds = {};

  /// Return the column of the vehicle in its block.
  std::size_t lane() const { return vehicle % widest_lanes; }
};

/// Return the odometry of a shown state.
/// \param shown  column of the vehicle in the rows of LaneBlocks::show()
/// \param draws  random numbers before this measurement
messages::Odometry measure(const double* shown, const OdometryErrors& errors, std::uint64_t seed,
                           double draws);

/// Note a call of a controller. Returns whether to measure the duration of this one.
inline bool count_call(BatchGuided& guided) {
  constexpr std::int64_t between_timings = 16;
  return guided.calls++ % between_timings == 0;
}

/// Measures durations.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace quadcore::batch
