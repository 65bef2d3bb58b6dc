#pragma once

#include "quadcore/plugin/tags.hpp"

namespace quadcore {

/// Return the tag for the radius of the rotors.
inline TagSpec rotor_radius_tag(const char* help) {
  return TagSpec::number("rotorRadius", "m", "0.075", help).above(0);
}

/// Return the tag for the relative loss of thrust per advance ratio.
inline TagSpec advance_ratio_loss_tag(const char* help) {
  return TagSpec::number("advanceRatioLoss", "", "1.1", help).at_least(0);
}

}  // namespace quadcore
