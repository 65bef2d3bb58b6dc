#include "command_watch.hpp"

#include <algorithm>

namespace quadcore::node {

void CommandWatch::arrived(double time) {
  if (stopped_) restart();
  is_late_ = false;
  if (!arrivals_.empty() && arrivals_.back() == time) return;  // during a pause, for example
  arrivals_.push_back(time);
  if (arrivals_.size() > most_arrivals) arrivals_.pop_front();
}

bool CommandWatch::check(double time) {
  if (stopped_ || arrivals_.size() < fewest_arrivals) return false;
  const double intervals = static_cast<double>(arrivals_.size() - 1);
  const double period = (arrivals_.back() - arrivals_.front()) / intervals;
  const double gap = time - arrivals_.back();
  if (gap <= 2 * period) return false;
  late_ += !is_late_;
  is_late_ = true;
  stopped_ = timeout_ > 0 && gap > std::max(timeout_, 2 * period);
  return stopped_;
}

void CommandWatch::restart() {
  arrivals_.clear();
  is_late_ = false;
  stopped_ = false;
}

}  // namespace quadcore::node
