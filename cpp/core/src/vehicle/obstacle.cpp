#include "quadcore/plugin/obstacle.hpp"

#include <algorithm>
#include <cmath>

namespace quadcore {
namespace {

/// Return the signed distance of a point from a box [m].
/// \param outside  coordinates of the point beyond the box's faces, negative inside
template <class Coordinates>
double distance_to_corner(const Coordinates& outside) {
  return outside.cwiseMax(0).norm() + std::min(0.0, outside.maxCoeff());
}

}  // namespace

double distance_to(const Obstacle& obstacle, const Vector3d& p_W) {
  const Vector3d& size = obstacle.size;
  if (obstacle.kind == ObstacleKind::plane) {
    return (size.dot(p_W) - obstacle.position_W.z()) / size.norm();
  }
  const Vector3d arm_W = p_W - obstacle.position_W;
  if (obstacle.kind == ObstacleKind::sphere) return arm_W.norm() - size.x();
  const Vector3d p = obstacle.orientation_W.conjugate() * arm_W;
  if (obstacle.kind == ObstacleKind::box)
    return distance_to_corner((p.cwiseAbs() - size / 2).eval());
  const Eigen::Vector2d beyond(p.head<2>().norm() - size.x(), std::abs(p.z()) - size.y() / 2);
  return distance_to_corner(beyond);
}

double outer_radius(const Obstacle& obstacle) {
  const Vector3d& size = obstacle.size;
  switch (obstacle.kind) {
    case ObstacleKind::box:
      return size.norm() / 2;
    case ObstacleKind::cylinder:
      return Eigen::Vector2d(size.x(), size.y() / 2).norm();
    case ObstacleKind::sphere:
      return size.x();
    case ObstacleKind::plane:
      break;
  }
  return INFINITY;
}

}  // namespace quadcore
