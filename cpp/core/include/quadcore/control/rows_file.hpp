#pragma once

#include <string>

#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Reads rows of time and place: a .csv file whose header is t,x,y,z or t,x,y,z,yaw, or a .yaml
/// file with `columns`, these names, and `rows`. Throws InputError with FILE:LINE.
Rows read_rows(const std::string& path);

}  // namespace control
}  // namespace quadcore
