#pragma once

#include <string>

#include "file.hpp"
#include "flight_log.hpp"

namespace quadcore::node {

/// A CSV file with a row after each step.
class CsvLog final : public FlightLog {
 public:
  /// Throws InputError if the file cannot be written.
  CsvLog(const std::string& path, const Simulation& simulation, LogRow row);
  void add(const Simulation& simulation) override;
  void close() override;

 private:
  void check(bool written);

  const std::string path_;
  LogRow row_;
  std::string line_;
  File file_;
};

}  // namespace quadcore::node
