#pragma once

#include "quadcore/control/reference.hpp"

namespace quadcore::control {

/// Where a shape stands and how its yaw goes: what all shapes have in common.
struct Place {
  double x, y, height;  ///< m
  double yaw, yaw_rate;
  bool along;

  Vector3d position() const { return {x, y, height}; }
  /// Gives a reference whose position is complete its yaw.
  void turn(double t, Reference& wanted) const;
};

/// The settings of a class that has a Place for a base.
template <class C>
Settings<C> with_place(Settings<C> settings) {
  using T = TagSpec;
  const Settings<C> place = {
      {T::number("x", "m", "0", "centre of the shape"), &C::x},
      {T::number("y", "m", "0", "centre of the shape"), &C::y},
      {T::number("height", "m", "10", "at which it begins"), &C::height},
      {T::number("yaw", "rad", "0", "at the start"), &C::yaw},
      {T::number("yaw_rate", "rad/s", "0", "with which the yaw grows"), &C::yaw_rate},
      {T::flag("along", "false", "yaw points along the horizontal velocity, `yaw` off it"),
       &C::along},
  };
  settings.insert(settings.end(), place.begin(), place.end());
  return settings;
}

}  // namespace quadcore::control
