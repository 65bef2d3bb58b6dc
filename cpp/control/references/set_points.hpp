#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "quadcore/control/reference.hpp"

/// \file
/// References that are given in flight, each from its beginning at t = 0 on.

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Something that does not change.
std::unique_ptr<ReferenceShape> hold(const Reference& wanted);

/// A velocity along the axes of the heading: ahead, to the left, up.
struct Heading {
  Vector3d velocity;  ///< [m/s]
  double yaw_rate;    ///< [rad/s]
};
/// Create a drive for so many seconds, followed by a hover.
std::unique_ptr<ReferenceShape> drive(const Reference& from, const Heading& heading, double lasts);

/// A point of a path. Missing derivatives are chosen for the smoothest path; at both ends they are
/// zero.
struct PathPoint {
  double t;  ///< [s]
  Vector3d position;
  double yaw;  ///< any equivalent angle
  struct Change {
    Vector3d of_position;
    double of_yaw;
  };
  std::optional<Change> velocity, acceleration;
};
/// Create the smoothest path from the present reference through points; the last one is held. A
/// first point at time 0 starts the path itself, and a single point is held with its given
/// derivatives. Throws InputError for times that are negative or do not increase.
std::unique_ptr<ReferenceShape> through(const Reference& from,
                                        const std::vector<PathPoint>& points);

}  // namespace control
}  // namespace quadcore
