#pragma once

#include <string>
#include <vector>

#include "quadcore/control/settings.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// When a controller is called and how late it acts, for all that may be told so: `rate`, `delay`.
const std::vector<TagSpec>& timing_table();
/// The default of one of the two.
double default_timing(const std::string& name);

/// A law with the parameters with which it flies a vehicle.
struct Gains {
  std::string law;      ///< one of laws()
  std::string vehicle;  ///< name of the robot for which they were made; "" if that is not told
  double rate = default_timing("rate");    ///< calls per second
  double delay = default_timing("delay");  ///< from a call to the first step that it commands [s]
  Values values;  ///< of the law's parameters; what is not there has the law's default
};

/// Reads a gains file: in YAML, `law`, and where wanted `vehicle`, `rate`, `delay`, `parameters` by
/// name, and `history`, which is for people. Throws InputError with FILE:LINE.
Gains read_gains(const std::string& path);

}  // namespace control
}  // namespace quadcore
