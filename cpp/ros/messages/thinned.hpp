#pragma once

#include <cmath>

namespace quadcore::node {

/// The rhythm of something that is worth sending less often than each step.
class Thinned {
 public:
  /// \param rate  messages per second of simulation time
  explicit Thinned(double rate) : rate_(rate) {}

  /// Whether a message is due at `time` [s], the first after a jump at once.
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
