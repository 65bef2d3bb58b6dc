#pragma once

#include <chrono>
#include <vector>

#include "lane_blocks.hpp"
#include "quadcore/batch.hpp"
#include "quadcore/control/schedule.hpp"
#include "quadcore/odometry_errors.hpp"

namespace quadcore::batch {

/// A vehicle of a block that follows a reference in the lanes.
struct Follower {
  std::size_t vehicle;
  const BatchGuide* guide;
  BatchGuided* guided;
  const OdometryErrors* errors;
  std::uint64_t seed;      ///< of the odometry
  double draws;            ///< random numbers before the measurement at the start
  std::int64_t steps = 0;  ///< in the lanes
  bool has_left = false;   ///< whether it has left the lanes; its results are then incomplete
  /// Speeds in effect at the end; empty before the first command.
  std::vector<double> speeds = {};

  /// Leave the lanes, where the vehicle then no longer moves.
  void leave(LaneBlocks& lanes) {
    has_left = true;
    lanes.let_fly(vehicle, false);
  }

  /// Return the column of the vehicle in its block.
  std::size_t lane() const { return vehicle % widest_lanes; }
};

/// Return the number of values in a row of a log: the time, and a state without its joint angles.
inline std::size_t log_width(std::size_t rotors) { return 1 + StateRow::joints + rotors; }

/// Return the sum of each number of a column of laws::VariationRow.
std::vector<double> list_sums(const LaneNumbers& variation, std::size_t lane);

/// Return the odometry of a shown state.
/// \param shown  column of the vehicle in the rows of LaneBlocks::show()
/// \param draws  random numbers before this measurement
messages::Odometry measure(const double* shown, const OdometryErrors& errors, std::uint64_t seed,
                           double draws);

/// Write the times of the call at a step and of the next ones, `count` in all [s].
inline void list_call_times(const control::Schedule& schedule, double step, double dt,
                            double* times, std::size_t count) {
  schedule.list_calls(step, dt, times, count);
  for (std::size_t i = 0; i < count; ++i) times[i] *= dt;
}

/// Call a controller and count the call.
/// \param seconds  where to add the duration of every sixteenth call [s]
template <class Call>
void count_call(std::int64_t& calls, std::vector<double>& seconds, const Call& call) {
  using Clock = std::chrono::steady_clock;
  if (calls++ % 16 != 0) return call();
  const Clock::time_point begin = Clock::now();
  call();
  seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
}

}  // namespace quadcore::batch
