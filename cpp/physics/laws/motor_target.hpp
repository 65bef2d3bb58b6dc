#pragma once

#include "lanes/pack.hpp"

namespace quadcore::laws {

/// Return the target rate of a joint [rad/s].
/// \param command  commanded speed of the real rotor; `fastest` is its maximum [rad/s]
QUADCORE_LAW double motor_target(double command, double fastest, double sim_slow) {
  const double followed = command > fastest ? fastest : command < -fastest ? -fastest : command;
  return followed / sim_slow;
}

}  // namespace quadcore::laws
