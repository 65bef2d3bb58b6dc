#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Throws InputError unless these are the speeds [rad/s] of a command for `width` rotors, none
/// beyond `fastest`.
void check_command(const double* speeds, std::size_t count, std::size_t width,
                   double fastest = std::numeric_limits<double>::infinity());

/// Open-loop commands: rows of time [s] and n rotor speeds [rad/s], held until the next row.
class Commands {
 public:
  /// (rows, 1 + n): time [s] and n rotor speeds [rad/s].
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// \param table  (rows, 1 + n), time in the first column, strictly increasing.
  /// Throws InputError on a wrong width, disorder, or a number that is not finite.
  Commands(Table table, std::size_t width);

  /// What makes rows of time and speeds no commands: a number that is not finite, disorder.
  struct Fault {
    Eigen::Index row;  ///< the first at fault, counted from 0
    std::string what;  ///< what is wrong with it, as errors say
  };
  /// What is wrong with a table of any width; nullopt if these are commands.
  static std::optional<Fault> fault(const Table& table);

  /// The row for the step that starts at `time`: the last with time <= t + 1e-9, or null before the
  /// first. The n speeds.
  const double* at(double time);

 private:
  Table table_;
  Eigen::Index next_ = 0;  ///< first row that is not yet due at the last asked time
};

}  // namespace quadcore
