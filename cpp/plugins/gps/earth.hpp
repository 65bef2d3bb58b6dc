#pragma once

#include <cmath>

#include "quadcore/elementary.hpp"

namespace quadcore::gps {

/// How many degrees a metre is, by the radii of curvature of the ellipsoid of WGS 84 (NIMA
/// TR8350.2) where the world is.
struct Earth {
  double north, east;  ///< deg/m

  Earth(double latitude, double altitude) {
    const double a = 6378137, f = 1 / 298.257223563, degrees = 180 / M_PI;
    const auto [sin, cos] = elementary::sincos(latitude / degrees);
    const double e2 = f * (2 - f), w2 = 1 - e2 * sin * sin, w = std::sqrt(w2);
    north = degrees / (a * (1 - e2) / (w2 * w) + altitude);
    east = degrees / ((a / w + altitude) * cos);
  }
};

}  // namespace quadcore::gps
