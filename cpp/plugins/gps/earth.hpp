#pragma once

#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/messages.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore::gps {

/// The ellipsoid of WGS 84 (NIMA TR8350.2) where a world lies on it, taken as level: its radii of
/// curvature say how many degrees a metre is.
class Earth {
 public:
  explicit Earth(const Origin& origin) : origin_(origin) {
    const double a = 6378137, f = 1 / 298.257223563, degrees = 180 / M_PI;
    const auto [sin, cos] = elementary::sincos(origin.latitude / degrees);
    const double e2 = f * (2 - f), w2 = 1 - e2 * sin * sin, w = std::sqrt(w2);
    north_ = degrees / (a * (1 - e2) / (w2 * w) + origin.altitude);
    east_ = degrees / ((a / w + origin.altitude) * cos);
  }

  /// Says where on Earth the position of a fix is.
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
