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
/// A drive for so many seconds, and then a hover.
std::unique_ptr<ReferenceShape> drive(const Reference& from, const Heading& heading, double lasts);

/// A point of a path. What is not given is what is smoothest, and at both ends zero.
struct PathPoint {
  double t;  ///< [s]
  Vector3d position;
  double yaw;  ///< any of those that are the same
  struct Change {
    Vector3d of_position;
    double of_yaw;
  };
  std::optional<Change> velocity, acceleration;
};
/// The smoothest path from where something is through points, the last of which is kept. A first
/// point at 0 begins the path itself, a lone one is held, with what is given of it.
/// Throws InputError on times that are negative or do not grow.
std::unique_ptr<ReferenceShape> through(const Reference& from,
                                        const std::vector<PathPoint>& points);

}  // namespace control
}  // namespace quadcore
