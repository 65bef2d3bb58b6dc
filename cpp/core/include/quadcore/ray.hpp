#pragma once

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/obstacle.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A half-line.
struct Ray {
  Vector3d origin_W;     ///< [m]
  Vector3d direction_W;  ///< unit vector
};

/// Return the distance along a ray to the surface of an obstacle [m], from inside as from outside;
/// infinite if the ray does not meet it.
double distance_along(const Ray& ray, const Obstacle& obstacle);

/// Return the distance along a ray to the ground or the nearest obstacle that stands still [m].
/// Free bodies and vehicles do not count.
/// \param maximum  longest distance of interest [m]; if nothing is as near, the result is infinite
double range_along(const Ray& ray, const World& world, double maximum);

}  // namespace quadcore
