#pragma once

#include "quadcore/urdf_tree.hpp"

namespace quadcore {

/// Lumps fixed links and checks the moving bodies. The topology has been checked.
Model lump(const UrdfTree& tree);

}  // namespace quadcore
