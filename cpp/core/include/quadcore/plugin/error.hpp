#pragma once

#include <stdexcept>
#include <string>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Base of every error that quadcore raises. The message is one line of UTF-8, ready to be shown:
/// control characters are replaced, whatever input it quotes, and the middle of a long one is cut.
class Error : public std::runtime_error {
 public:
  /// Takes any text and makes it such a line, as one_line() does.
  explicit Error(const std::string& what);
};

/// The input is at fault: a file, a tag, an argument. Nothing was changed by the refused call.
class InputError : public Error {
 public:
  using Error::Error;
};

/// The flight itself failed: a state that is not finite, has diverged, or that a plugin refuses.
class FlightError : public Error {
 public:
  /// A failure at a time of the simulation [s].
  FlightError(double time, const std::string& what) : Error(what), time_(time) {}
  /// Simulation time of the failure [s].
  double time() const { return time_; }

 private:
  double time_;
};

/// Text by others as Error has it: one line of UTF-8 without control characters.
std::string one_line(const std::string& text);

/// What the exception that is being handled says; for use in a catch block, where others' code may
/// have thrown anything.
std::string what_was_thrown();

}  // namespace quadcore
