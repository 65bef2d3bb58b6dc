#pragma once

#include <ros/console.h>

#include <chrono>
#include <iterator>
#include <map>
#include <mutex>
#include <string>

namespace quadcore::node {

/// Logs each warning at most once a second, so that no warning hides another. It does not use
/// ROS_WARN_THROTTLE, which depends on simulation time and may stop during a pause.
class WarningLimiter {
 public:
  void warn(const std::string& what) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const Clock::time_point now = Clock::now();
      for (auto said = quiet_until_.begin(); said != quiet_until_.end();) {
        said = said->second <= now ? quiet_until_.erase(said) : std::next(said);
      }
      if (quiet_until_.size() >= most_at_once) return;
      if (!quiet_until_.emplace(what, now + std::chrono::seconds(1)).second) return;
    }
    ROS_WARN("%s", what.c_str());
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_at_once = 20;  ///< different warnings a second

  std::mutex mutex_;
  std::map<std::string, Clock::time_point> quiet_until_;
};

}  // namespace quadcore::node
