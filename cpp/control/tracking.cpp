#include "tracking.hpp"

namespace quadcore::control {

Tracking::Tracking(const ModelledVehicle& model, const TrackingGains& g)
    : model_(model),
      switches_{g.feed_forward, g.flat_rates, g.integral, g.drag, g.gyroscopic},
      numbers_{{g.kp_xy, g.kp_xy, g.kp_z},
               {g.ki_xy, g.ki_xy, g.ki_z},
               {g.kd_xy, g.kd_xy, g.kd_z},
               g.integral_limit,
               numbers_of(static_cast<const AttitudeGains&>(g)),
               numbers_of(model)} {}

WrenchController::Feeds Tracking::feeds() const {
  using Feeds = WrenchController::Feeds;
  if (!switches_.flat_rates) return Feeds::nothing;
  return switches_.drag ? Feeds::flat_state_with_drag : Feeds::flat_state;
}

}  // namespace quadcore::control
