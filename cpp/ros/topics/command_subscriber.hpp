#pragma once

#include <ros/ros.h>

#include <mutex>
#include <string>
#include <vector>

#include "caller_queue.hpp"
#include "command_topics.hpp"
#include "diagnostics.hpp"
#include "flight_thread.hpp"
#include "warning_limiter.hpp"

namespace quadcore::node {

/// Receives commands from topics, in the thread that reads them. It counts and reports rejected
/// commands, and warns if two nodes send commands.
class CommandSubscriber {
 public:
  CommandSubscriber(ros::NodeHandle& nh, const std::vector<CommandTopic>& topics,
                    FlightThread& flight);
  Refusals refusals() const;

 private:
  void take(const CommandTopic& topic, const std::string& commander,
            const std::vector<double>& speeds);

  FlightThread& flight_;
  const std::vector<CommandTopic> topics_;
  mutable std::mutex mutex_;
  Refusals refusals_;
  std::string commander_;  ///< sender of the last command
  WarningLimiter limiter_;
  CallerQueue queue_;
  std::vector<ros::Subscriber> subscribers_;  ///< last, because they use the other members
};

}  // namespace quadcore::node
