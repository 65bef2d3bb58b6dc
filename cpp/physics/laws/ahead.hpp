#pragma once

#include "lanes/pack.hpp"

namespace quadcore::laws {

/// How far what moves at a speed [m/s] may come within dt [s], and more than that as it is
/// accelerated [m].
template <class T>
QUADCORE_LAW T ahead(T speed, double dt) {
  constexpr double acceleration = 100;  // m/s^2
  return dt * (2 * speed + acceleration * dt);
}

}  // namespace quadcore::laws
