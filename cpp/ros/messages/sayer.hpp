#pragma once

#include <ros/console.h>

#include <chrono>
#include <iterator>
#include <map>
#include <mutex>
#include <string>

namespace quadcore::node {

/// Says each thing at most once a second, however often it happens, so that no fault hides another.
/// Not ROS_WARN_THROTTLE: that goes by simulation time, which may stand still.
class Sayer {
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
  static constexpr std::size_t most_at_once = 20;  ///< different things a second

  std::mutex mutex_;
  std::map<std::string, Clock::time_point> quiet_until_;
};

}  // namespace quadcore::node
