#pragma once

#include "quadcore/control/attitude_loop.hpp"

namespace quadcore::control {

/// Add the attitude gains to the settings of a class derived from AttitudeGains.
template <class G>
Settings<G> with_attitude(Settings<G> settings) {
  using T = TagSpec;
  const Settings<G> attitude = {
      {T::number("kr_rp", "1/s^2", "300", "gain of the roll and pitch error").at_least(0),
       &G::kr_rp},
      {T::number("kw_rp", "1/s", "30", "gain of the roll and pitch rate errors").at_least(0),
       &G::kw_rp},
      {T::number("kr_yaw", "1/s^2", "3", "gain of the yaw error").at_least(0), &G::kr_yaw},
      {T::number("kw_yaw", "1/s", "3", "gain of the yaw rate error").at_least(0), &G::kw_yaw},
      {T::flag("drag", "true", "compensates the modelled aerodynamic force and torque"), &G::drag},
      {T::flag("gyroscopic", "true", "compensates the rotors' gyroscopic torque"), &G::gyroscopic},
  };
  settings.insert(settings.end(), attitude.begin(), attitude.end());
  return settings;
}

}  // namespace quadcore::control
