#pragma once

#include <optional>
#include <vector>

#include "quadcore/plugin/triangle_mesh.hpp"

namespace quadcore {

/// Return the surface of a prism over a closed polygon, from z = 0 to a height [m]. Empty if the
/// polygon crosses itself or has no area.
std::optional<TriangleMesh> extrude_polyline(std::vector<Eigen::Vector2d> points, double height);

}  // namespace quadcore
