#pragma once

#include <string>

#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Reads rows of time and place: a .csv file with the columns t, x, y, z and perhaps yaw, or a
/// .yaml file with `columns`, these names, and `rows`. Of a log they are these columns, and the yaw
/// of its orientation. Throws InputError with FILE:LINE, also on times that do not grow.
Rows read_rows(const std::string& path);

}  // namespace control
}  // namespace quadcore
