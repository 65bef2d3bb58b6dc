#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Throw InputError unless these are the speeds [rad/s] of a command for `width` rotors, none above
/// `fastest`.
void check_command(const double* speeds, std::size_t count, std::size_t width,
                   double fastest = std::numeric_limits<double>::infinity());

/// Open-loop commands: rows of time [s] and n rotor speeds [rad/s], held until the next row.
class Commands {
 public:
  /// (rows, 1 + n): time [s] and n rotor speeds [rad/s].
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// \param table  (rows, 1 + n) with strictly increasing time in the first column.
  /// Throws InputError for a wrong width, unsorted times, or a number that is not finite.
  Commands(Table table, std::size_t width);

  /// Error in a command table: a number that is not finite, or unsorted times.
  struct Fault {
    Eigen::Index row;  ///< first invalid row, counted from 0
    std::string what;  ///< error message
  };
  /// Return the error in a table of any width; nullopt if it is valid.
  static std::optional<Fault> fault(const Table& table);

  /// Return the n speeds for the step that starts at `time`: those of the last row with time <= t +
  /// 1e-9, or null before the first row.
  const double* at(double time);

 private:
  Table table_;
  Eigen::Index next_ = 0;  ///< first row that was not yet due at the last call
};

}  // namespace quadcore
