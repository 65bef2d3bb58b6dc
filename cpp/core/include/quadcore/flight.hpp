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
  /// (count, columns) in row-major order with the columns of log_columns(): the state, then each
  /// requested topic; then the columns that the caller fills.
  std::vector<double> table;
  /// (count, terms, 6) in row-major order with the terms of Simulation::wrench_terms(): force and
  /// torque in frame axes about the vehicle's centre of mass, acting from the logged state on.
  /// Empty unless requested.
  std::vector<double> wrenches;
};

/// One logged run of a simulation that is advanced in pieces. The caller can show progress,
/// interrupt it without losing the log, and store the rows as they are produced.
class Flight {
 public:
  /// Log the present state at once, then after every `log_every` steps.
  /// \param topics   names of topics to log
  /// \param to_fill  number of columns at the end of each row that are NaN until the caller fills
  ///                 them
  /// Throws InputError if log_every < 1, or if a topic does not exist or is named twice.
  Flight(Simulation& simulation, std::optional<Commands> commands, std::int64_t log_every,
         bool wrenches, const std::vector<std::string>& topics = {}, std::size_t to_fill = 0);

  /// Simulate n steps, each with the command that is due at its start. Throws like step(); logged
  /// rows remain. The rates are those of Simulation::step().
  void advance(std::int64_t n, TotalVariation* rates = nullptr);
  /// Allocate the memory for the rows of n more steps.
  void make_room(std::int64_t n);

  /// \name Parts of advance(), for vehicles that a Fleet advances
  /// @{

  /// Publish the command that is due. Returns the number of steps, at most n, until the next.
  std::int64_t prepare(std::int64_t n);
  /// Log the present state if it is due after so many steps.
  void finish(std::int64_t steps);
  /// @}

  /// Return the rows logged since the last call.
  LogRows take();

 private:
  void log();

  Simulation& simulation_;
  std::optional<Commands> commands_;
  std::int64_t log_every_;
  bool log_wrenches_;
  std::vector<std::size_t> topics_;
  std::size_t to_fill_;
  std::size_t row_size_ = 0, wrenches_size_ = 0;  ///< number of values in a row
  std::int64_t steps_to_row_ = log_every_;
  LogRows rows_;
};

}  // namespace quadcore
