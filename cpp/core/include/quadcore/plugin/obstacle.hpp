#pragma once

#include <memory>
#include <string>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/triangle_mesh.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A collision shape of a world that stands still. The solid side of a plane is opposite to its
/// normal; the plane is infinite and intersects the world's z axis at `position_W`. x, y and the
/// rotation of a plane have no effect, as in Gazebo.
struct Obstacle {
  std::string model;                ///< name of its model: MODEL, or MODEL::NESTED
  std::string name;                 ///< LINK::COLLISION
  ShapeKind kind = ShapeKind::box;  ///< defines the meaning of `size`
  /// Box x, y, z; cylinder radius, length; sphere radius [m]; plane: normal of any length; mesh:
  /// extent of its vertices along its axes.
  Vector3d size = Vector3d::Ones();
  Vector3d center = Vector3d::Zero();                   ///< of a mesh's vertices in its axes [m]
  std::shared_ptr<const TriangleMesh> mesh;             ///< null unless it is a mesh
  Vector3d position_W = Vector3d::Zero();               ///< m
  Quaterniond orientation_W = Quaterniond::Identity();  ///< axes of the shape in the world
  Surface surface = {};    ///< contact parameters; max_vel and min_depth count for free bodies
  double slip1 = 0;        ///< sliding speed per friction force along fdir1 [m/(N s)]
  double slip2 = 0;        ///< sliding speed per friction force across fdir1 [m/(N s)]
  double restitution = 0;  ///< counts for two shapes that both have it; the smaller one
  double restitution_speed = 0;  ///< slower impacts do not bounce [m/s]
  std::string where;             ///< FILE:LINE
};

/// Return the signed distance of a point from an obstacle's surface, negative inside [m]. That of a
/// mesh, which may be open, has no sign.
double distance_to(const Obstacle& obstacle, const Vector3d& p_W);

/// Return a lower bound of distance_to(), which of a mesh takes little time: the distance from the
/// box that contains it.
double least_distance_to(const Obstacle& obstacle, const Vector3d& p_W);

/// Return the distance of an obstacle's farthest point from its centre [m]; infinite for a plane.
double outer_radius(const Obstacle& obstacle);

}  // namespace quadcore
