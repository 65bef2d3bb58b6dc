#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "flight_log.hpp"

namespace quadcore::node {

/// A log of the flight since the last jump: a reset, a state that was set, a clock that was set
/// back. What was flown before a jump becomes a file of its own beside it, FILE.before_1.csv and so
/// on, which replaces no other; unless it was moved away.
class LogPerFlight {
 public:
  /// \param path  of the log
  /// \param open  opens it anew
  /// Throws what `open` throws.
  LogPerFlight(const std::string& path, std::function<std::unique_ptr<FlightLog>()> open);
  /// A row, after the start, each step and, `jumped`, each jump.
  void add(const Simulation& simulation, bool jumped);
  /// Writes what is left.
  void close();
  /// What went wrong in writing; "" = nothing.
  const std::string& error() const { return error_; }

 private:
  void begin_anew();
  void keep();
  void fail(const std::string& what);

  const std::string path_;
  const std::function<std::unique_ptr<FlightLog>()> open_;
  std::unique_ptr<FlightLog> log_;  ///< null once one could not be kept or opened
  std::string error_;               ///< what went wrong first
  double time_ = 0;                 ///< of the last row [s]
  std::int64_t rows_ = 0;           ///< since the start or the last jump
};

}  // namespace quadcore::node
