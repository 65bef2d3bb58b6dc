#pragma once

#include <utility>

#include "quadcore/control/reference.hpp"

namespace quadcore::control {

/// Yaw of a reference.
struct YawMotion {
  double yaw = 0, yaw_rate = 0;  ///< rad, rad/s
  bool along = false;

  /// Set the yaw of a reference with a complete position.
  /// \param standing  heading without horizontal velocity [rad]
  void turn(double t, Reference& wanted, double standing = 0) const;
};

/// Position and yaw of a reference.
struct Place : YawMotion {
  double x, y, height;  ///< m

  Vector3d position() const { return {x, y, height}; }
};

/// Add the settings of a class derived from YawMotion.
/// \param moves  whether there is a horizontal velocity
template <class C>
Settings<C> with_yaw(Settings<C> settings, bool moves = true) {
  using T = TagSpec;
  settings.push_back({T::number("yaw", "rad", "0", "yaw at the start"), &C::yaw});
  settings.push_back(
      {T::number("yaw_rate", "rad/s", "0", "constant rate of the yaw"), &C::yaw_rate});
  if (moves) {
    settings.push_back(
        {T::flag("along", "false", "yaw follows the horizontal velocity, with `yaw` as an offset"),
         &C::along});
  }
  return settings;
}

/// Add the settings of a class derived from Place.
template <class C>
Settings<C> with_place(Settings<C> settings, bool moves = true) {
  using T = TagSpec;
  const Settings<C> place = {
      {T::number("x", "m", "0", "centre of the shape along x"), &C::x},
      {T::number("y", "m", "0", "centre of the shape along y"), &C::y},
      {T::number("height", "m", "10", "height at the start"), &C::height},
  };
  settings.insert(settings.end(), place.begin(), place.end());
  return with_yaw<C>(std::move(settings), moves);
}

}  // namespace quadcore::control
