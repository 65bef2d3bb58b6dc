#pragma once

#include <string>
#include <vector>

#include "file.hpp"
#include "flight_log.hpp"

namespace quadcore::node {

/// A MATLAB file. It contains columns, so rows wait in an unnamed file until the flight ends. Then
/// the complete file appears, or no file.
class MatLog final : public FlightLog {
 public:
  /// Throws InputError if the file cannot be written.
  MatLog(const std::string& path, const Simulation& simulation, LogRow row);
  void add(const Simulation& simulation) override;
  void close() override;

 private:
  /// Writes the file from the rows.
  void write(const double* rows, std::size_t count) const;

  const std::string path_, part_;
  const std::vector<std::string> ignored_;
  LogRow row_;
  File rows_;
};

}  // namespace quadcore::node
