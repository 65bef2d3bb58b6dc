#pragma once

#include "drag.hpp"
#include "flapping.hpp"
#include "law_list.hpp"
#include "thrust.hpp"

namespace quadcore::laws {

/// All rotor force laws in the order of their wrench terms. To add one, write a struct like those
/// in drag.hpp and name it here.
using RotorLaws =
    LawList<Thrust, Reaction, InducedDrag, TranslationalDrag, ProfileDrag, ParasiticDrag, Flapping>;

}  // namespace quadcore::laws
