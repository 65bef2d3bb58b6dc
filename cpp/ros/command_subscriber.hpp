#pragma once

#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <mutex>
#include <string>

#include "diagnostics.hpp"
#include "flight_thread.hpp"
#include "sayer.hpp"

namespace quadcore::node {

/// Takes commands from a topic, on the callback thread; those that are refused are counted and
/// told, and so are those of two who command at once.
class CommandSubscriber {
 public:
  CommandSubscriber(ros::NodeHandle& nh, const std::string& topic, bool lockstep,
                    FlightThread& flight);
  Refusals refusals() const;

 private:
  void take(const ros::MessageEvent<std_msgs::Float64MultiArray const>& event);

  FlightThread& flight_;
  ros::Subscriber subscriber_;
  mutable std::mutex mutex_;
  Refusals refusals_;
  std::string commander_;  ///< who sent the last command
  Sayer sayer_;
};

}  // namespace quadcore::node
