#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "quadcore/plugin/counts.hpp"

namespace quadcore::control {

/// When a controller is asked and when its commands act: at a rate, and after a delay. Immutable;
/// its state is numbers of its caller, all zero at the beginning.
class Schedule {
 public:
  Schedule(double rate, double delay, std::size_t rotors)
      : rate_(rate),
        delay_(delay),
        rotors_(rotors),
        places_(static_cast<std::size_t>(std::ceil(delay * rate)) + 2) {}

  std::size_t state_size() const { return kUnderWay + places_ * place_size(); }

  /// Takes part in a step.
  /// \param step  since the beginning, whose number is 0; some may be left out
  /// \param dt    length of a step [s]
  /// \param ask   called as ask(period, speeds) where a call is due, with the seconds since the
  ///              last one and until the next
  /// Returns the speeds of the command that arrives, (rotors,), or null.
  template <class Ask>
  const double* update(double step, double dt, double* state, const Ask& ask) const {
    // By the count of steps: the sum of their times would slip.
    const double due = std::floor(step * (rate_ * dt) + rounding) + 1;
    if (due > state[kAsked]) {
      state[kAsked] = due;
      double* const order = place(state, state[kSent]);
      // The first command acts at once, for nothing precedes it.
      order[0] = step + (step > 0 ? std::max(std::ceil(delay_ / dt - rounding), 0.0) : 0);
      ask(std::max(1 / rate_, dt), order + 1);  // called once a step at most
      state[kSent] += 1;
    }
    const double* arrived = nullptr;
    for (auto waiting = count_of(state[kSent] - state[kArrived], places_); waiting > 0; --waiting) {
      const double* const order = place(state, state[kArrived]);
      if (order[0] > step) break;
      arrived = order + 1;
      state[kArrived] += 1;
    }
    return arrived;
  }

 private:
  /// Periods asked plus one, commands sent and commands that arrived; then a ring of commands under
  /// way, each the step of its arrival and the speeds.
  enum Memory : std::size_t { kAsked, kSent, kArrived, kUnderWay };

  static constexpr double rounding = 1e-6;  ///< of a period, or of a step

  std::size_t place_size() const { return 1 + rotors_; }
  double* place(double* state, double count) const {
    return state + kUnderWay + ring_index(count, places_) * place_size();
  }

  double rate_, delay_;
  std::size_t rotors_, places_;
};

}  // namespace quadcore::control
