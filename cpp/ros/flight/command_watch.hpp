#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace quadcore::node {

/// Watches whether commands keep arriving without lockstep, by the controller's own rate.
///
/// The mean interval of the last commands is the period of the controller. A command is late if it
/// is missing for two periods, and the commands have stopped if it is also missing for the timeout.
/// A few commands sent by hand have no period, and raise no alarm. All times are those of the
/// simulation, in s.
///
/// Not synchronised: the owner's lock guards it.
class CommandWatch {
 public:
  /// \param timeout  minimum time without a command before they have stopped [s]; 0 = never
  explicit CommandWatch(double timeout) : timeout_(timeout) {}

  /// Call when a command is accepted.
  void arrived(double time);
  /// Call after each step. Returns whether the commands have stopped just now.
  bool check(double time);
  /// Forgets the commands: after a jump of the time.
  void restart();

  bool have_stopped() const { return stopped_; }
  double last_arrival() const { return arrivals_.back(); }
  std::int64_t late_count() const { return late_; }

 private:
  static constexpr std::size_t fewest_arrivals = 5;  ///< before there is a period
  static constexpr std::size_t most_arrivals = 20;

  double timeout_;
  std::deque<double> arrivals_;
  bool is_late_ = false;  ///< the present gap has been counted
  bool stopped_ = false;
  std::int64_t late_ = 0;
};

}  // namespace quadcore::node
