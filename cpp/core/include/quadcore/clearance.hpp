#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Distances of a vehicle's collision shapes from the obstacles of a world. The level ground plane
/// is no obstacle. A shape on a rotor counts as the cylinder that it sweeps.
class Clearance {
 public:
  /// Copies the shapes of both. Collision meshes are left out.
  Clearance(const Model& model, const World& world);

  /// The nearest obstacle.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  ///< m; 0 if the shapes overlap
    std::size_t obstacle = 0;                                   ///< index in World::obstacles
  };
  /// Return the obstacle that is nearest to a vehicle whose frame has a pose in the world.
  Nearest find(const Vector3d& p_WF, const Quaterniond& R_WF) const;

  /// The pose of a vehicle's frame in the world.
  struct FramePose {
    Vector3d position_W;        ///< [m]
    Quaterniond orientation_W;  ///< of the frame
  };
  /// Return the distance of this vehicle's shapes from those of another one, or `known` if it is
  /// not shorter [m]; 0 if they overlap.
  double distance_between_vehicles(const Clearance& other, const FramePose& own,
                                   const FramePose& others, double known) const;

  /// A convex shape: a sphere, a box or a cylinder along its z axis.
  struct Convex {
    ShapeKind kind;        ///< defines the meaning of `size`, as in Collision
    Vector3d size;         ///< m
    Vector3d position;     ///< m
    Quaterniond rotation;  ///< axes of the shape
    double radius;         ///< distance of the farthest point from the centre [m]
  };

 private:
  std::vector<Convex> shapes_F_;
  std::vector<Convex> obstacles_W_;
  const std::vector<Obstacle> given_;
};

}  // namespace quadcore
