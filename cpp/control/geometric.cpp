#include "geometric.hpp"

namespace quadcore::control {

const Settings<Geometric::Gains>& Geometric::settings() {
  static const Settings<Gains> all = with_tracking<Gains>({});
  return all;
}

Demand Geometric::demand(const Instant& instant, double* memory) const {
  const std::optional<FlatState> flat = tracking_.fed_forward(instant);
  const Vector3d f_W = tracking_.force_W(instant, flat, tracking_.acceleration(instant, memory));
  const Vector3d z_W = instant.now.orientation * Vector3d::UnitZ();
  return {f_W.dot(z_W),
          tracking_.torque(instant, tracking_.angular_acceleration(instant, flat, f_W))};
}

}  // namespace quadcore::control
