#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quadcore/commands.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A piece of a log.
struct LogRows {
  std::int64_t count = 0;  ///< rows
  /// (count, columns) in row-major order, columns as log_columns() names them: of the state, then
  /// of each topic asked for.
  std::vector<double> table;
  /// (count, terms, 6) in row-major order, terms as Simulation::wrench_terms() names them: force
  /// then torque, frame axes, about the vehicle's centre of mass, as they act from the logged state
  /// on. Empty unless asked for.
  std::vector<double> wrenches;
};

/// One logged run of a simulation, advanced piece by piece so that a caller can show progress,
/// interrupt it without losing what is logged, and put the rows where they belong as they come.
class Flight {
 public:
  /// Logs the present state at once, then after every `log_every` steps.
  /// \param topics  names of those to log, too
  /// Throws InputError if log_every < 1, or if a topic is not declared or named twice.
  Flight(Simulation& simulation, std::optional<Commands> commands, std::int64_t log_every,
         bool wrenches, const std::vector<std::string>& topics = {});

  /// Flies n steps, each with the command that is due at its start. Throws what step() throws;
  /// what was logged stays.
  void advance(std::int64_t n);

  /// Hands over what was logged since the last call.
  LogRows take();

 private:
  void log();

  Simulation& simulation_;
  std::optional<Commands> commands_;
  std::int64_t log_every_;
  bool log_wrenches_;
  std::vector<std::size_t> topics_;
  std::size_t row_size_ = 0, wrenches_size_ = 0;  ///< numbers of a row
  std::int64_t steps_ = 0;
  LogRows rows_;
};

}  // namespace quadcore
