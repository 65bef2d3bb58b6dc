#pragma once

#include <string>
#include <vector>

#include "quadcore/control/settings.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Return the parameters of a controller's timing: `rate` and `delay`.
const std::vector<TagSpec>& timing_table();
/// Return the default of one of these parameters.
double default_timing(const std::string& name);

/// A controller with its parameters for a vehicle.
struct Gains {
  std::string law;                         ///< name of a controller, see list_controllers()
  std::string vehicle;                     ///< name of the vehicle that the gains are for, or ""
  double rate = default_timing("rate");    ///< calls per second
  double delay = default_timing("delay");  ///< from a call to the first step with its command [s]
  Values values;  ///< parameters of the controller that differ from its defaults
};

/// Read a gains file. It is a YAML file with `law` and optionally `vehicle`, `rate`, `delay`,
/// `parameters` by name, and `history`, which is informative. Throws InputError with FILE:LINE.
Gains read_gains(const std::string& path);

}  // namespace control
}  // namespace quadcore
