#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <chrono>
#include <string>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Rejected commands.
struct Refusals {
  std::int64_t count = 0;
  std::string last;  ///< reason
};

/// Publishes the progress of the flight once a second of wall time.
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
