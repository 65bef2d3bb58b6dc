#pragma once

#include <utility>

#include "quadcore/control/reference.hpp"

namespace quadcore::control {

/// How the yaw of a shape goes.
struct YawLaw {
  double yaw = 0, yaw_rate = 0;  ///< rad, rad/s
  bool along = false;

  /// Gives a reference whose position is complete its yaw.
  /// \param standing  heading where there is no horizontal velocity to point along [rad]
  void turn(double t, Reference& wanted, double standing = 0) const;
};

/// Where a shape stands and how its yaw goes.
struct Place : YawLaw {
  double x, y, height;  ///< m

  Vector3d position() const { return {x, y, height}; }
};

/// The settings of a class that has a YawLaw for a base.
/// \param moves  whether there is a horizontal velocity
template <class C>
Settings<C> with_yaw(Settings<C> settings, bool moves = true) {
  using T = TagSpec;
  settings.push_back({T::number("yaw", "rad", "0", "at the start"), &C::yaw});
  settings.push_back(
      {T::number("yaw_rate", "rad/s", "0", "with which the yaw grows"), &C::yaw_rate});
  if (moves) {
    settings.push_back(
        {T::flag("along", "false", "yaw points along the horizontal velocity, `yaw` off it"),
         &C::along});
  }
  return settings;
}

/// The settings of a class that has a Place for a base.
template <class C>
Settings<C> with_place(Settings<C> settings, bool moves = true) {
  using T = TagSpec;
  const Settings<C> place = {
      {T::number("x", "m", "0", "centre of the shape"), &C::x},
      {T::number("y", "m", "0", "centre of the shape"), &C::y},
      {T::number("height", "m", "10", "at which it begins"), &C::height},
  };
  settings.insert(settings.end(), place.begin(), place.end());
  return with_yaw<C>(std::move(settings), moves);
}

}  // namespace quadcore::control
