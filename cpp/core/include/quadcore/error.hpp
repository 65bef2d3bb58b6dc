#pragma once

#include <stdexcept>
#include <string>

namespace quadcore {

/// Base of every error that quadcore raises. The message is one line, ready to be shown.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The input is at fault: a file, a tag, an argument. Nothing was changed by the refused call.
class InputError : public Error {
 public:
  using Error::Error;
};

/// The flight itself failed: a state that is not finite, has diverged, or that a plugin refuses.
class FlightError : public Error {
 public:
  FlightError(double time, const std::string& what) : Error(what), time_(time) {}
  /// Simulation time of the failure [s].
  double time() const { return time_; }

 private:
  double time_;
};

}  // namespace quadcore
