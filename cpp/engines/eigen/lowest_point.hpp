#pragma once

#include "quadcore/kinematics.hpp"
#include "quadcore/model.hpp"

namespace quadcore {

/// Height of the lowest point of all collision shapes above z = 0 [m]; infinite without shapes.
double lowest_point(const Model& model, const Kinematics& kinematics);

/// Throws InputError on a shape whose lowest point is not known (a mesh).
void check_collisions(const Model& model);

}  // namespace quadcore
