#pragma once

#include "lanes/pack.hpp"

namespace quadcore::laws {

/// Return the target rate of a joint [rad/s].
/// \param command  commanded speed of the real rotor; `fastest` is its maximum [rad/s]
template <class T>
QUADCORE_LAW T motor_target(T command, T fastest, T sim_slow) {
  const T within = chosen_by(command < -fastest, -fastest, command);
  return chosen_by(command > fastest, fastest, within) / sim_slow;
}

}  // namespace quadcore::laws
