#pragma once

#include <ode/ode.h>

#include <vector>

namespace quadcore {

/// Number of points for which Gazebo 11 asks the collider of a pair.
constexpr int most_points = 250;

/// Find the contact points of two shapes as Gazebo 11's colliders do, and return their number.
/// \param points  has room for most_points
int find_points(dGeomID one, dGeomID other, std::vector<dContactGeom>& points);

/// Keep at most so many of the points found, and return their number. The deepest of the points
/// from the last kept one on takes its place, as in Gazebo.
int keep_points(std::vector<dContactGeom>& points, int found, int most);

}  // namespace quadcore
