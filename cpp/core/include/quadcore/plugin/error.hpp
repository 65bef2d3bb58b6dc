#pragma once

#include <stdexcept>
#include <string>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Base class of all quadcore errors. The message is one line of UTF-8 that is ready for display:
/// control characters are replaced and long messages are shortened in the middle.
class Error : public std::runtime_error {
 public:
  /// Convert any text to one line with one_line().
  explicit Error(const std::string& what);
};

/// Invalid input: a file, a tag or an argument. The rejected call changed nothing.
class InputError : public Error {
 public:
  using Error::Error;
};

/// Failure of the flight itself: the state is not finite, has diverged, or a plugin rejects it.
class FlightError : public Error {
 public:
  /// Create a failure at a simulation time [s].
  FlightError(double time, const std::string& what) : Error(what), time_(time) {}
  /// Return the simulation time of the failure [s].
  double time() const { return time_; }

 private:
  double time_;
};

/// Return a text as one line of UTF-8 without control characters.
std::string one_line(const std::string& text);

/// Return the message of the current exception. For use in a catch block after foreign code, which
/// may throw anything.
std::string what_was_thrown();

}  // namespace quadcore
