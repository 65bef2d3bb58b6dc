#pragma once

#include "quadcore/plugin/model.hpp"

namespace quadcore {

constexpr int most_touching_points = 8;

/// Where a shape can touch the ground: the corners of a box, the lowest point of a sphere, and of
/// each rim of a cylinder the lowest point and those a quarter, a half and three quarters round
/// from it, which carry a lying rim as any other four would. None of a mesh.
/// \param p_WS      the shape's centre [m]
/// \param R_WS      its orientation
/// \param points_W  filled [m]
/// \returns how many there are
int touching_points(const Collision& shape, const Vector3d& p_WS, const Matrix3d& R_WS,
                    Vector3d (&points_W)[most_touching_points]);

/// How far a shape reaches from its centre [m].
double reach(const Collision& shape);

}  // namespace quadcore
