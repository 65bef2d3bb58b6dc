#pragma once

#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/messages.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore::gps {

/// The WGS 84 ellipsoid (NIMA TR8350.2) at the world's origin, treated as level. Its radii of
/// curvature convert metres to degrees.
class Earth {
 public:
  explicit Earth(const Origin& origin) : origin_(origin) {
    const double a = 6378137, f = 1 / 298.257223563, degrees = 180 / M_PI;
    const auto [sin, cos] = elementary::sincos(origin.latitude / degrees);
    const double e2 = f * (2 - f), w2 = 1 - e2 * sin * sin, w = std::sqrt(w2);
    north_ = degrees / (a * (1 - e2) / (w2 * w) + origin.altitude);
    east_ = degrees / ((a / w + origin.altitude) * cos);
  }

  /// Set the position on Earth of a fix from its position in the world.
  void locate(messages::Fix& fix) const {
    fix.latitude = origin_.latitude + north_ * fix.position.y();
    fix.longitude = std::remainder(origin_.longitude + east_ * fix.position.x(), 360);
    fix.altitude = origin_.altitude + fix.position.z();
  }

 private:
  Origin origin_;
  double north_, east_;  ///< deg/m
};

}  // namespace quadcore::gps
