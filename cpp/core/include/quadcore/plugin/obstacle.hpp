#pragma once

#include <string>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Kind of an obstacle; see Obstacle for its dimensions.
enum class ObstacleKind { box, cylinder, sphere, plane };

/// A collision shape of a world that stands still. The solid side of a plane is opposite to its
/// normal; the plane is infinite and intersects the world's z axis at `position_W`. x, y and the
/// rotation of a plane have no effect, as in Gazebo.
struct Obstacle {
  std::string model;                      ///< name of its model: MODEL, or MODEL::NESTED
  std::string name;                       ///< LINK::COLLISION
  ObstacleKind kind = ObstacleKind::box;  ///< defines the meaning of `size`
  /// Box x, y, z; cylinder radius, length; sphere radius [m]; plane: normal of any length.
  Vector3d size = Vector3d::Ones();
  Vector3d position_W = Vector3d::Zero();               ///< m
  Quaterniond orientation_W = Quaterniond::Identity();  ///< axes of the shape in the world
  Surface surface = {};  ///< contact parameters; max_vel and min_depth have no effect
  double slip1 = 0;      ///< sliding speed per friction force along fdir1 [m/(N s)]
  double slip2 = 0;      ///< sliding speed per friction force across fdir1 [m/(N s)]
  std::string where;     ///< FILE:LINE
};

/// Return the signed distance of a point from an obstacle's surface, negative inside [m].
double distance_to(const Obstacle& obstacle, const Vector3d& p_W);

/// Return the distance of an obstacle's farthest point from its centre [m]; infinite for a plane.
double outer_radius(const Obstacle& obstacle);

}  // namespace quadcore
