#pragma once

#include <ctime>
#include <string>

/// \file
/// What holds for every input. The functions throw std::logic_error where it does not.

/// A message is one line without control characters, and short.
void check_one_line(const std::string& message);

/// An input takes at most a second of the processor's time from its construction on.
class TimeLimit {
 public:
  void check() const;

 private:
  std::clock_t begin_ = std::clock();
};
