#pragma once

#include <cmath>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/range_messages.hpp"
#include "quadcore/ray.hpp"

namespace quadcore::sensing {

/// Limits of a sensor that measures distances.
struct RangeLimits {
  double minimum, maximum;  ///< m

  /// Create from the tags `minRange` and `maxRange`.
  explicit RangeLimits(const Parameters& p)
      : minimum(p.number("minRange")), maximum(p.number("maxRange")) {
    if (!(minimum < maximum)) {
      throw InputError("<minRange> is not below <maxRange>. Write a smaller <minRange>.");
    }
  }

  /// Return the measured distance along a ray with an error [m]: infinite beyond the maximum,
  /// minus infinite below the minimum (REP 117).
  double measure(const Ray& ray, const World& world, double error) const {
    const double range = range_along(ray, world, maximum + std::abs(error)) + error;
    if (range < minimum) return -INFINITY;
    return range <= maximum ? range : INFINITY;
  }

  static TagSpec minimum_tag() {
    return TagSpec::number("minRange", "m", "0.05",
                           "shortest measured distance; the range of anything nearer is -inf")
        .at_least(0);
  }
  /// \param fallback  default [m]
  static TagSpec maximum_tag(const char* fallback) {
    return TagSpec::number("maxRange", "m", fallback,
                           "longest measured distance; without anything as near, the range is inf")
        .above(0);
  }
};

/// Warn that a sensor of distances does not detect what moves in the world.
inline void warn_of_undetected(const PluginSetup& setup) {
  if (setup.world.free_bodies.empty()) return;
  setup.warnings.push_back(
      "the sensor does not detect free bodies of the world, only what stands still.");
}

}  // namespace quadcore::sensing
