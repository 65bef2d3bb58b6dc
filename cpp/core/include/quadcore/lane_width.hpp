#pragma once

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Return the number of doubles that this processor computes at once: 2, 4 or 8. The environment
/// variable QUADCORE_LANES (1, 2, 4 or 8) limits it. All widths give bit-identical results. Throws
/// InputError for another value of the variable.
int lane_width();

}  // namespace quadcore
