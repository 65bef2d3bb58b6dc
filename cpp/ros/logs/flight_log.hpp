#pragma once

#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// What stands in a log of a flight.
class LogRow {
 public:
  /// \param names  topics to log, too
  /// Throws InputError if one is not declared.
  LogRow(const Simulation& simulation, const std::vector<std::string>& names);
  /// Names of the numbers: those of the state, then TOPIC.FIELD.
  const std::vector<std::string>& columns() const { return columns_; }
  /// The names in one line, with commas between.
  std::string header() const;
  /// Of the simulation.
  const std::vector<std::size_t>& topics() const { return topics_; }
  /// The numbers of now.
  const std::vector<double>& of(const Simulation& simulation);

 private:
  const std::vector<std::size_t> topics_;
  std::vector<std::string> columns_;
  std::vector<double> row_;  ///< kept, so that it needs no new memory
};

/// A file that holds a flight, as `quadcore run --log` writes it. A disk may fill up while it
/// flies: that does not end the flight, but is told.
class FlightLog {
 public:
  virtual ~FlightLog() = default;
  /// A row, after the start and each step.
  virtual void add(const Simulation& simulation) = 0;
  /// Writes what is left.
  virtual void close() = 0;
  /// What went wrong in writing; "" = nothing.
  const std::string& error() const { return error_; }

 protected:
  /// What goes wrong first counts.
  void fail(const std::string& what) {
    if (error_.empty()) error_ = what;
  }

 private:
  std::string error_;
};

class LogPerFlight;

/// Whether a name is one of a log: it ends in .csv, .mat or .bag, or belongs to a pipe or a device.
bool is_log(const std::string& path);

/// The log, a file per flight, of the format that a file's name asks for; CSV into a pipe.
/// It refers to simulation and node.
/// \param nh  whose names the topics of a bag have
/// \param frame_prefix  of the vehicle's frames there
/// Throws InputError if the file cannot be written or a topic is not declared.
std::unique_ptr<LogPerFlight> open_log(const std::string& path, const Simulation& simulation,
                                       const std::vector<std::string>& topics,
                                       const ros::NodeHandle& nh, const std::string& frame_prefix);

/// How a file that cannot be written is told, for the reason that errno has.
std::string unwritable(const std::string& path);
/// The same of one that holds a part of the flight only.
std::string cut_short(const std::string& path);

}  // namespace quadcore::node
