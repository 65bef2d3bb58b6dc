#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "quadcore/plugin/counts.hpp"
#include "quadcore/plugin/export.hpp"

namespace quadcore::control {

/// Timing of a controller: calls at a rate, commands that act after a delay. Immutable; the caller
/// owns the state, which is all zero at the start.
class Schedule {
 public:
  /// \param rate   calls per simulated second
  /// \param delay  from a call to the step at which its command acts [s]
  Schedule(double rate, double delay, std::size_t rotors)
      : rate_(rate),
        period_(1 / rate),
        delay_(delay),
        rotors_(rotors),
        places_(static_cast<std::size_t>(std::ceil(delay * rate)) + 2) {}

  /// Return the number of state values.
  std::size_t state_size() const { return kUnderWay + places_ * place_size(); }

  /// Call the controller if it is due in this step.
  /// \param step  number of the step, counted from 0; steps may be skipped
  /// \param dt    time step [s]
  /// \param ask   called as ask(period, speeds) when due, with the seconds since the last call and
  ///              until the next
  /// Returns the speeds of the command that takes effect, (rotors,), or null.
  template <class Ask>
  const double* update(double step, double dt, double* state, const Ask& ask) const {
    // By the number of steps, because a sum of times would drift.
    const double due = count_due(step, dt);
    if (due > state[kAsked]) {
      state[kAsked] = due;
      const double period = std::max(period_, dt);  // at most one call per step
      // The first command acts at once, because no other command precedes it.
      if (step == 0 || delay_ <= 0) {
        double* const speeds = place(state, 0) + 1;
        ask(period, speeds);
        return speeds;
      }
      double* const order = place(state, state[kSent]);
      order[0] = step + count_delayed(dt);
      ask(period, order + 1);
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

  /// Return the step of the first call after a step.
  double next_call(double step, double dt) const {
    return next_call(step, dt, count_due(step, dt));
  }

  /// Write the step of a call and those of the next ones, `count` in all.
  void list_calls(double step, double dt, double* steps, std::size_t count) const {
    // Rates above one call per step skip calls; the steps are consecutive then.
    const double due = count_due(step, dt);
    for (std::size_t i = 0; i < count; ++i) {
      steps[i] = step;
      step = next_call(step, dt, due + static_cast<double>(i));
    }
  }

  /// Return the first step after an updated one at which a call is due or a command takes effect.
  double next_event(double step, double dt, double* state) const {
    const double call = next_call(step, dt, state[kAsked]);
    if (state[kSent] == state[kArrived]) return call;
    return std::min(call, place(state, state[kArrived])[0]);
  }

 private:
  /// Number of calls plus one, commands sent and commands that took effect; then a ring buffer of
  /// pending commands, each with the step of its effect and the speeds.
  enum Memory : std::size_t { kAsked, kSent, kArrived, kUnderWay };

  static constexpr double rounding = 1e-6;  ///< tolerance as a fraction of a period or a step
  static constexpr double most_exact = 9007199254740992.0;  ///< from here on all numbers are whole

  /// Return the number of periods that have passed at a step.
  double count_periods(double step, double dt) const { return step * (rate_ * dt) + rounding; }
  /// Return the number of calls that are due up to a step.
  double count_due(double step, double dt) const { return whole(count_periods(step, dt)) + 1; }
  /// Return the step of the first call after a step up to which so many calls were due.
  double next_call(double step, double dt, double due) const {
    const double steps_per_call = 1 / (rate_ * dt);
    // Rounding may put the product next to the right step, not further away.
    double next = std::max(step + 1, whole((due - rounding) * steps_per_call) + 1);
    while (next > step + 1 && count_periods(next - 1, dt) >= due) next -= 1;
    while (count_periods(next, dt) < due) next += 1;
    return next;
  }
  /// Return the number of steps from a call until its command acts.
  double count_delayed(double dt) const { return std::max(std::ceil(delay_ / dt - rounding), 0.0); }
  /// Return the whole part of a positive number. Faster than std::floor() without SSE 4.1.
  static double whole(double number) {
    return number < most_exact ? static_cast<double>(static_cast<std::int64_t>(number)) : number;
  }
  std::size_t place_size() const { return 1 + rotors_; }
  double* place(double* state, double count) const {
    return state + kUnderWay + ring_index(count, places_) * place_size();
  }

  double rate_, period_, delay_;  ///< 1/s, s and s
  std::size_t rotors_, places_;
};

}  // namespace quadcore::control
