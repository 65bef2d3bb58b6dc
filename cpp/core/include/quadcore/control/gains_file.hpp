#pragma once

#include <string>

#include "quadcore/control/settings.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

constexpr double longest_delay = 10;  ///< s

/// A law with the parameters with which it flies a vehicle.
struct Gains {
  std::string law;
  std::string vehicle;  ///< name of the robot for which they were made; "" if that is not told
  double rate = 500;    ///< calls per second
  double delay = 0;  ///< from a call to the first step that it commands, at most longest_delay [s]
  Values values;     ///< of the law's parameters; what is not there has the law's default
};

/// Reads a gains file: in YAML, `law`, and where wanted `vehicle`, `rate`, `delay`, `parameters` by
/// name, and `history`, which is for people. Throws InputError with FILE:LINE.
Gains read_gains(const std::string& path);

}  // namespace control
}  // namespace quadcore
