#pragma once

#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// Return the rotation by the smallest angle that takes the direction `from` to the direction `to`.
/// Between opposite directions, which have many, it returns one.
/// Use it instead of Quaterniond::FromTwoVectors(): the singular value decomposition inside takes
/// the compiler ten seconds in every file that contains it.
/// \param from, to  vectors of any length > 0
Quaterniond shortest_rotation(const Vector3d& from, const Vector3d& to);

}  // namespace quadcore
