#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Writes the log that `quadcore run --log` writes, a row after each step.
class CsvLog {
 public:
  /// Throws InputError if the file cannot be written.
  CsvLog(const std::string& path, const Simulation& simulation);
  void add(const VehicleState& state);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace quadcore::node
