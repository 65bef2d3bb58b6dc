#pragma once

#include "drag.hpp"
#include "flapping.hpp"
#include "law_list.hpp"
#include "thrust.hpp"

namespace quadcore::laws {

/// The laws of rotors, in the order of their wrench terms. To add one, write a struct as those in
/// drag.hpp are and name it here.
using RotorLaws =
    LawList<Thrust, Reaction, InducedDrag, TranslationalDrag, ProfileDrag, ParasiticDrag, Flapping>;

}  // namespace quadcore::laws
