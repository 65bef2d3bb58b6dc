#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "frames.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// The columns and the current row of a log.
class LogRow {
 public:
  /// \param names  additional topics to log
  /// Throws InputError if a topic is not declared.
  LogRow(const Simulation& simulation, const std::vector<std::string>& names);
  /// Names of the numbers: those of the state, then TOPIC.FIELD.
  const std::vector<std::string>& columns() const { return columns_; }
  /// Returns the names in one line, separated by commas.
  std::string header() const;
  /// Indices of the logged topics.
  const std::vector<std::size_t>& topics() const { return topics_; }
  /// Computes the current row.
  const std::vector<double>& fill(const Simulation& simulation);

 private:
  const std::vector<std::size_t> topics_;
  std::vector<std::string> columns_;
  std::vector<double> row_;  ///< stored to reuse its memory
};

/// A log of a flight, like that of `quadcore run --log`. A write error, such as a full disk, is
/// reported and does not end the flight.
class FlightLog {
 public:
  virtual ~FlightLog() = default;
  /// Adds a row.
  virtual void add(const Simulation& simulation) = 0;
  /// Writes the rest.
  virtual void close() = 0;
  /// Returns the write error; "" = no error.
  const std::string& error() const { return error_; }

 protected:
  /// Stores the first error.
  void fail(const std::string& what) {
    if (error_.empty()) error_ = what;
  }

 private:
  std::string error_;
};

class LogPerFlight;

/// Whether a path can be a log: it ends in .csv, .mat or .bag, or is a pipe or a device.
bool is_log(const std::string& path);

/// Opens a log with one file per flight. The suffix determines the format; a pipe gets CSV. The log
/// keeps references to simulation and node.
/// \param every  steps per row
/// \param nh  namespace of the topics in a bag
/// \param frames  frames of the messages in a bag
/// Throws InputError if the file cannot be written or a topic is not declared.
std::unique_ptr<LogPerFlight> open_log(const std::string& path, const Simulation& simulation,
                                       const std::vector<std::string>& topics, std::int64_t every,
                                       const ros::NodeHandle& nh, const Frames& frames);

/// Describes that a file cannot be written, with the reason in errno.
std::string describe_open_failure(const std::string& path);
/// Describes that a log is incomplete, with the reason in errno.
std::string describe_truncation(const std::string& path);

}  // namespace quadcore::node
