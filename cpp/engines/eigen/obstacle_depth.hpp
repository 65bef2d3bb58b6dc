#pragma once

#include "quadcore/plugin/obstacle.hpp"

namespace quadcore {

/// How a ball touches an obstacle. The depth is a continuous function of the ball's position, of
/// which the normal is minus the gradient, so that springs along the normal conserve energy.
struct ObstacleDepth {
  double depth;       ///< distance to leave the obstacle by; negative outside [m]
  Vector3d normal_W;  ///< direction in which to leave it, unit
};

/// Return the depth of a ball in a box, a cylinder, a sphere or a plane. A ball of radius 0 is a
/// point.
ObstacleDepth find_depth(const Obstacle& obstacle, const Vector3d& p_W, double radius);

}  // namespace quadcore
