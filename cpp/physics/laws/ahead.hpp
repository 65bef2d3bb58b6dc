#pragma once

#include "lanes/pack.hpp"

namespace quadcore::laws {

/// Return an upper bound of the distance [m] travelled at a speed [m/s] within dt [s], with a
/// margin for acceleration.
template <class T>
QUADCORE_LAW T ahead(T speed, double dt) {
  constexpr double acceleration = 100;  // m/s^2
  return dt * (2 * speed + acceleration * dt);
}

}  // namespace quadcore::laws
