#include "geometric.hpp"

namespace quadcore::control {

const Settings<Geometric::Gains>& Geometric::settings() {
  static const Settings<Gains> all = with_tracking<Gains>({});
  return all;
}

Demand Geometric::demand(const LawInput& input, double* memory) const {
  const std::optional<FlatState> flat = tracking_.fed_forward(input);
  const Vector3d f_W = tracking_.force_W(input, flat, tracking_.acceleration(input, memory));
  const Vector3d z_W = input.now.orientation * Vector3d::UnitZ();
  return {f_W.dot(z_W), tracking_.torque(input, tracking_.angular_acceleration(input, flat, f_W))};
}

}  // namespace quadcore::control
