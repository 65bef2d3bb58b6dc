#pragma once

#include "quadcore/control/attitude_loop.hpp"

namespace quadcore::control {

/// The settings of gains that have those for a base.
template <class G>
Settings<G> with_attitude(Settings<G> settings) {
  using T = TagSpec;
  const Settings<G> attitude = {
      {T::number("kr_rp", "1/s^2", "300", "of the error of roll and pitch").at_least(0), &G::kr_rp},
      {T::number("kw_rp", "1/s", "30", "of the error of their rates").at_least(0), &G::kw_rp},
      {T::number("kr_yaw", "1/s^2", "3", "of the error of yaw").at_least(0), &G::kr_yaw},
      {T::number("kw_yaw", "1/s", "3", "of the error of its rate").at_least(0), &G::kw_yaw},
      {T::flag("drag", "true", "makes up for the believed force and torque of the air"), &G::drag},
      {T::flag("gyroscopic", "true", "makes up for the rotors' gyroscopic torque"), &G::gyroscopic},
  };
  settings.insert(settings.end(), attitude.begin(), attitude.end());
  return settings;
}

}  // namespace quadcore::control
