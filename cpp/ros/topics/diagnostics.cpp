#include "diagnostics.hpp"

#include <cstdio>

namespace quadcore::node {
namespace {

/// Minimum part of the requested factor without a warning.
constexpr double fair_share = 0.95;

std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle& nh, const FlightReport& start,
                         const std::string& command_topic)
    : command_topic_(command_topic),
      publisher_(nh.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10)),
      last_(start) {}

void Diagnostics::send(const FlightReport& report, const Refusals& refusals) {
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - last_time_).count();
  const double factor = (report.time - last_.time) / elapsed;

  diagnostic_msgs::DiagnosticStatus status;
  status.name = ros::this_node::getName().substr(1) + ": flight";
  status.hardware_id = "quadcore";
  status.level = diagnostic_msgs::DiagnosticStatus::OK;
  status.message = report.paused ? "paused" : "running";
  if (!report.failure.empty()) {
    status.level = diagnostic_msgs::DiagnosticStatus::ERROR;
    status.message = report.failure;
  } else if (report.waits_for_clock) {
    status.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status.message = "waiting for a publisher of /clock";
    ROS_WARN_ONCE("%s", status.message.c_str());
  } else if (report.waits_for_command && report.steps == last_.steps) {
    status.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status.message = "waiting for a command on " + command_topic_;
    ROS_WARN_ONCE("lockstep: %s", status.message.c_str());
  } else if (report.commands_stopped) {
    status.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status.message = "the controller has stopped sending commands on " + command_topic_;
  } else if (!report.paused && !last_.paused && factor < fair_share * report.real_time_factor) {
    status.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status.message = "behind the real-time factor of " + to_text(report.real_time_factor);
  } else if (refusals.count != refused_before_) {
    status.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status.message = "commands rejected: " + refusals.last;
  }
  const auto add = [&status](const std::string& key, const std::string& value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    status.values.push_back(pair);
  };
  add("time (s)", to_text(report.time));
  add("real-time factor", to_text(factor));
  add("steps", std::to_string(report.steps));
  add("overruns", std::to_string(report.overruns));
  add("commands", std::to_string(report.commands));
  add("waiting commands", std::to_string(report.waiting_commands));
  add("late commands", std::to_string(report.late_commands));
  add("rejected commands", std::to_string(refusals.count));

  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp.fromSec(report.time);
  message.status.push_back(status);
  publisher_.publish(message);
  last_ = report;
  last_time_ = now;
  refused_before_ = refusals.count;
}

}  // namespace quadcore::node
