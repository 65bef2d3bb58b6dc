#pragma once

#include <vector>

#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// Return points spread over the surface of a shape, in its axes. Those of a box lie on a grid with
/// its corners, those of a cylinder on rings and the axis. A sphere has only its centre.
std::vector<Vector3d> spread_points(const Collision& shape);

}  // namespace quadcore
