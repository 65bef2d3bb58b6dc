#include "control/geometric.hpp"

namespace quadcore::control {

const Settings<Geometric::Gains>& Geometric::settings() {
  static const Settings<Gains> all = with_tracking<Gains>({});
  return all;
}

Demand Geometric::demand(const Instant& instant, double* memory) const {
  const Belief& belief = tracking_.belief();
  const Vector3d up(0, 0, belief.gravity);
  const Vector3d f_W =
      belief.mass * (tracking_.acceleration(instant, memory) + up) - tracking_.air_force_W(instant);
  const Vector3d z_W = instant.now.orientation * Vector3d::UnitZ();
  return {f_W.dot(z_W), tracking_.torque(instant, tracking_.angular_acceleration(instant, f_W))};
}

}  // namespace quadcore::control
