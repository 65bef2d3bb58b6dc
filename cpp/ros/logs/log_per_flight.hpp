#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "flight_log.hpp"

namespace quadcore::node {

/// A log of the flight since the last jump: a reset, a new state, or a clock that was set back. The
/// previous log becomes FILE.before_1.csv and so on in the same folder, without replacing a file,
/// unless it was moved.
class LogPerFlight {
 public:
  /// \param path  path of the log
  /// \param every  steps per row
  /// \param open  opens a new log
  /// Rethrows exceptions of `open`.
  LogPerFlight(const std::string& path, std::int64_t every,
               std::function<std::unique_ptr<FlightLog>()> open);
  /// Call after the start, each step and, with `jumped`, each jump. Adds a row if one is due.
  void add(const Simulation& simulation, bool jumped);
  /// Writes the rest.
  void close();
  /// Returns the write error; "" = no error.
  const std::string& error() const { return error_; }

 private:
  void start_new_file();
  void keep_previous();
  void fail(const std::string& what);

  const std::string path_;
  const std::int64_t every_;  ///< steps per row
  const std::function<std::unique_ptr<FlightLog>()> open_;
  std::unique_ptr<FlightLog> log_;  ///< null after a log could not be kept or opened
  std::string error_;               ///< the first error
  double time_ = 0;                 ///< time of the last step [s]
  std::int64_t states_ = 0;         ///< since the start or the last jump, with the first one
};

}  // namespace quadcore::node
