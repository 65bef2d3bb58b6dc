#pragma once

#include <string>

#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Read rows of time and position: a .csv file with the columns t, x, y, z and optionally yaw, or a
/// .yaml file with these names in `columns`, and `rows`. In a log, the yaw comes from the
/// orientation. Throws InputError with FILE:LINE, also if the times do not increase.
Rows read_rows(const std::string& path);

}  // namespace control
}  // namespace quadcore
