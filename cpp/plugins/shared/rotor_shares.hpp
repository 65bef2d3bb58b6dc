#pragma once

#include "quadcore/plugin/tags.hpp"
#include "quadcore/rotor_shares.hpp"

namespace quadcore {

/// Of plugins that drive rotors.
inline TagSpec power_tag() {
  return TagSpec::text("power", "power",
                       "topic: of each rotor the share of the motor's torque that is left, 0 to 1; "
                       "1 before the first message, 0 lets the rotor turn freely");
}

}  // namespace quadcore
