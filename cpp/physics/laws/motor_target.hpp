#pragma once

#include "lanes/pack.hpp"

namespace quadcore::laws {

/// Rate that a joint is to take [rad/s].
/// \param command  of a real rotor's speed, and the fastest that is followed [rad/s]
QUADCORE_LAW double motor_target(double command, double fastest, double sim_slow) {
  const double followed = command > fastest ? fastest : command < -fastest ? -fastest : command;
  return followed / sim_slow;
}

}  // namespace quadcore::laws
