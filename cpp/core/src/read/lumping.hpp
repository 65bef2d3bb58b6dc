#pragma once

#include "quadcore/urdf_tree.hpp"

namespace quadcore {

/// Lump fixed links and check the moving bodies. Requires a checked topology.
Model lump(const UrdfTree& tree);

}  // namespace quadcore
