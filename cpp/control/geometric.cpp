#include "geometric.hpp"

namespace quadcore::control {

const Settings<Geometric::Gains>& Geometric::settings() {
  static const Settings<Gains> all = with_tracking<Gains>({});
  return all;
}

Demand Geometric::demand(const ControllerInput& input, double* memory) const {
  return tracking_.demand(input, [&](const TrackingFormulas<double>& formulas) {
    return demand_geometrically(formulas, memory_of<GeometricMemory>(memory));
  });
}

std::shared_ptr<const LaneWrenchController> Geometric::in_lanes(double /*period*/) const {
  return std::make_shared<LaneWrenchController>(LaneWrenchController{
      ControllerKind::geometric, tracking_.switches(), list_numbers(tracking_.numbers())});
}

}  // namespace quadcore::control
