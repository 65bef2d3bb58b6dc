#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Writes the log that `quadcore run --log` writes, a row after each step. A disk may fill up while
/// it flies: that does not end the flight, but is told.
class CsvLog {
 public:
  /// Throws InputError if the file cannot be written.
  CsvLog(const std::string& path, const Simulation& simulation);
  void add(const VehicleState& state);
  /// Writes what is left.
  void close();
  /// What went wrong in writing; "" = nothing.
  const std::string& error() const { return error_; }

 private:
  void check(bool written);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::string path_;
  std::string error_;
  std::vector<double> row_;
  std::string line_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace quadcore::node
