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
  /// \param topics  names of those to log, too
  /// Throws InputError if the file cannot be written or a topic is not declared.
  CsvLog(const std::string& path, const Simulation& simulation,
         const std::vector<std::string>& topics);
  void add(const Simulation& simulation);
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
  const std::vector<std::size_t> topics_;
  std::string error_;
  std::vector<double> row_;
  std::string line_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace quadcore::node
