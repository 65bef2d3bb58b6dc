#pragma once

#include "quadcore/plugin/tags.hpp"
#include "quadcore/rotor_shares.hpp"

namespace quadcore {

/// Return the tag for the remaining thrust of each rotor, of plugins that change or read it.
inline TagSpec effectiveness_tag() {
  return TagSpec::text("effectiveness", "effectiveness",
                       "topic that the aerodynamics plugin reads");
}

/// Return the tag for the remaining motor torque of plugins that drive rotors.
inline TagSpec power_tag() {
  return TagSpec::text("power", "power",
                       "topic with the remaining fraction of each motor's torque, 0 to 1; 1 before "
                       "the first message, 0: the rotor turns freely");
}

}  // namespace quadcore
