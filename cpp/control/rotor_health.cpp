#include "quadcore/control/rotor_health.hpp"

#include "quadcore/rotor_shares.hpp"

namespace quadcore::control {

RotorHealth::RotorHealth(const VehicleDescription& flown) : joints_(flown.driven()) {}

void RotorHealth::update(const Topic& health, double time, const Controller& controller,
                         double* state) const {
  if (health.count == 0) return;
  check_shares(health, time);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    controller.set_remaining(i, health.values[joints_[i]], state);
  }
}

}  // namespace quadcore::control
