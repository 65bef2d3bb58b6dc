#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <chrono>
#include <string>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Commands that were refused.
struct Refusals {
  std::int64_t count = 0;
  std::string last;  ///< why
};

/// Sends, once a second of wall time, how the flight keeps up.
class Diagnostics {
 public:
  Diagnostics(ros::NodeHandle& nh, const FlightReport& start, const std::string& command_topic);
  void send(const FlightReport& report, const Refusals& refusals);

 private:
  using Clock = std::chrono::steady_clock;

  const std::string command_topic_;
  ros::Publisher publisher_;
  FlightReport last_;
  std::int64_t refused_before_ = 0;
  Clock::time_point last_time_ = Clock::now();
};

}  // namespace quadcore::node
