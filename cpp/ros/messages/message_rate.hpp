#pragma once

#include <cmath>

namespace quadcore::node {

/// Determines when to send a message that is sent less often than each step.
class MessageRate {
 public:
  /// \param rate  messages per second of simulation time
  explicit MessageRate(double rate) : rate_(rate) {}

  /// Whether a message is due at `time` [s]; after a jump, one is always due.
  bool due(double time, bool jumped) {
    const double count = std::floor(time * rate_ + 1e-6);
    if (count == last_ && !jumped) return false;
    last_ = count;
    return true;
  }

 private:
  double rate_;
  double last_ = -1;
};

}  // namespace quadcore::node
