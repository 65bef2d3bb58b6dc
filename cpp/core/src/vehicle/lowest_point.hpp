#pragma once

#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// Return how far a shape, which is not a mesh, reaches down from its centre [m]. R_WS is its
/// orientation.
double reach_down(const Collision& shape, const Matrix3d& R_WS);
/// Return the height of the lowest point of all collision shapes above z = 0 [m]; infinite without
/// shapes.
double lowest_point(const Model& model, const Kinematics& kinematics);

/// Throw InputError for a shape whose lowest point is unknown (a mesh).
void check_collisions(const Model& model);

}  // namespace quadcore
