#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quadcore/commands.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore {

/// Names of the log columns for n rotors: t, pose, velocities, rotor speeds.
std::vector<std::string> log_columns(std::size_t rotor_count);
/// What follows the names in a CSV log: "" or, on a line of its own, "# ignored: NAME, ...". Below
/// them, because most programs take the first line for the names and skip comments afterwards.
std::string log_remark(const std::vector<std::string>& ignored);
/// Appends what stands in them.
void append_log_row(const VehicleState& state, std::vector<double>& table);

/// One logged run of a simulation, advanced piece by piece so that a caller can show progress and
/// interrupt it without losing what is logged.
class Flight {
 public:
  /// Logs the present state at once, then after every `log_every` steps.
  /// Throws InputError if log_every < 1.
  Flight(Simulation& simulation, std::optional<Commands> commands, std::int64_t log_every);

  /// Flies n steps, each with the command that is due at its start. Throws what step() throws;
  /// what was logged stays.
  void advance(std::int64_t n);

  std::int64_t rows() const { return rows_; }
  /// (rows, columns) in row-major order, columns as log_columns() names them.
  const std::vector<double>& table() const { return table_; }
  /// (rows, terms, 6) in row-major order, terms as Simulation::wrench_terms() names them: force
  /// then torque, frame axes, about the vehicle's centre of mass, as they act from the logged state
  /// on.
  const std::vector<double>& wrenches() const { return wrenches_; }

 private:
  void log();

  Simulation& simulation_;
  std::optional<Commands> commands_;
  std::int64_t log_every_;
  std::int64_t steps_ = 0;
  std::int64_t rows_ = 0;
  std::vector<double> table_;
  std::vector<double> wrenches_;
};

}  // namespace quadcore
