#pragma once

#include <ros/ros.h>

#include <mutex>
#include <string>
#include <vector>

#include "command_topics.hpp"
#include "diagnostics.hpp"
#include "flight_thread.hpp"
#include "sayer.hpp"

namespace quadcore::node {

/// Takes commands from topics, on the callback thread; those that are refused are counted and
/// told, and so are those of two who command at once.
class CommandSubscriber {
 public:
  CommandSubscriber(ros::NodeHandle& nh, const std::vector<CommandTopic>& topics, bool lockstep,
                    FlightThread& flight);
  Refusals refusals() const;

 private:
  void take(const CommandTopic& topic, const std::string& commander,
            const std::vector<double>& speeds);

  FlightThread& flight_;
  const std::vector<CommandTopic> topics_;
  std::vector<ros::Subscriber> subscribers_;
  mutable std::mutex mutex_;
  Refusals refusals_;
  std::string commander_;  ///< who sent the last command
  Sayer sayer_;
};

}  // namespace quadcore::node
