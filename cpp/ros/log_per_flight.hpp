#pragma once

#include <functional>
#include <memory>
#include <string>

#include "flight_log.hpp"

namespace quadcore::node {

/// A log of the flight since the last jump: a reset, a state that was set, a clock that was set
/// back. Times grow in a log, so what was flown before a jump becomes a file of its own beside it,
/// FILE.before_1.csv and so on, which replaces no other.
class LogPerFlight final : public FlightLog {
 public:
  /// \param path  of the log
  /// \param open  opens it anew
  /// Throws what `open` throws.
  LogPerFlight(const std::string& path, std::function<std::unique_ptr<FlightLog>()> open);
  void add(const Simulation& simulation) override;
  void close() override;

 private:
  void begin_anew();
  void keep();

  const std::string path_;
  const std::function<std::unique_ptr<FlightLog>()> open_;
  std::unique_ptr<FlightLog> log_;  ///< null once one could not be kept or opened
  double time_ = 0;                 ///< of the last row [s]
  std::int64_t rows_ = 0;           ///< since the start or the last jump
};

}  // namespace quadcore::node
