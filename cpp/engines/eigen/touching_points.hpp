#pragma once

#include "quadcore/plugin/model.hpp"

namespace quadcore {

constexpr int most_touching_points = 8;

/// Compute the possible contact points of a shape: the corners of a box, the lowest point of a
/// sphere, and four points of each rim of a cylinder. The latter are the lowest point and those a
/// quarter, a half and three quarters around. A mesh has none.
/// \param p_WS      centre of the shape [m]
/// \param R_WS      orientation of the shape
/// \param points_W  contact points [m]
/// \returns the number of points
int touching_points(const Collision& shape, const Vector3d& p_WS, const Matrix3d& R_WS,
                    Vector3d (&points_W)[most_touching_points]);

}  // namespace quadcore
