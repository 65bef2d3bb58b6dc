#pragma once

#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// How far a shape, none of them a mesh, reaches down from its centre; R_WS is its orientation [m].
double reach_down(const Collision& shape, const Matrix3d& R_WS);
/// Height of the lowest point of all collision shapes above z = 0 [m]; infinite without shapes.
double lowest_point(const Model& model, const Kinematics& kinematics);

/// Throws InputError on a shape whose lowest point is not known (a mesh).
void check_collisions(const Model& model);

}  // namespace quadcore
