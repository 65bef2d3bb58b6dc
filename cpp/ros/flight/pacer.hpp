#pragma once

#include <chrono>
#include <cstdint>

namespace quadcore::node {

/// Computes when each step is due, at a fixed ratio of simulation time to the monotonic clock.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  /// \param dt      length of a step [s]
  /// \param factor  simulated seconds per second; 0 = as fast as possible
  Pacer(double dt, double factor) : period_(factor > 0 ? dt / factor : 0) { restart(); }

  /// Makes the next step due now.
  void restart() {
    start_ = Clock::now();
    steps_ = 0;
  }
  Clock::time_point due() const {
    using std::chrono::duration;
    // Computed from the start, so rounding errors do not accumulate.
    return start_ + std::chrono::duration_cast<Clock::duration>(
                        duration<double>(period_ * static_cast<double>(steps_)));
  }
  /// Call when a step begins. Returns whether it is late by more than its own length.
  bool begin_step() {
    const double late = std::chrono::duration<double>(Clock::now() - due()).count();
    // Small delays are caught up. After a long delay, the schedule restarts.
    if (late > most_to_catch_up) restart();
    ++steps_;
    return period_ > 0 && late > period_;
  }

 private:
  static constexpr double most_to_catch_up = 0.1;  // s

  double period_;
  Clock::time_point start_;
  std::int64_t steps_ = 0;
};

}  // namespace quadcore::node
