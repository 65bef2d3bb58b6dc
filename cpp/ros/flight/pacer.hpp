#pragma once

#include <chrono>
#include <cstdint>

namespace quadcore::node {

/// Says when each step is due so that simulation time keeps a fixed ratio to the monotonic clock.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  /// \param dt      length of a step [s]
  /// \param factor  simulated seconds per second; 0 = as fast as possible
  Pacer(double dt, double factor) : period_(factor > 0 ? dt / factor : 0) { restart(); }

  /// The next step is due now.
  void restart() {
    start_ = Clock::now();
    steps_ = 0;
  }
  Clock::time_point due() const {
    using std::chrono::duration;
    // From the start, not from the last step: rounding must not add up.
    return start_ + std::chrono::duration_cast<Clock::duration>(
                        duration<double>(period_ * static_cast<double>(steps_)));
  }
  /// A step begins now. Returns whether it overran: it was late by more than its own length.
  bool begin_step() {
    const double late = std::chrono::duration<double>(Clock::now() - due()).count();
    // Small delays are made up for; after a long one the schedule starts anew, without a rush.
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
