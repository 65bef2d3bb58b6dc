#include "geometric.hpp"

namespace quadcore::control {

const Settings<Geometric::Gains>& Geometric::settings() {
  static const Settings<Gains> all = with_tracking<Gains>({});
  return all;
}

Demand Geometric::demand(const LawInput& input, double* memory) const {
  return tracking_.demand(input, [&](const TrackingLaw<double>& law) {
    return demand_geometrically(law, memory_of<GeometricMemory>(memory));
  });
}

std::shared_ptr<const LaneLaw> Geometric::in_lanes(double /*period*/) const {
  return std::make_shared<LaneLaw>(
      LaneLaw{LawKind::geometric, tracking_.switches(), list_numbers(tracking_.numbers())});
}

}  // namespace quadcore::control
