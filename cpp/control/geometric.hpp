#pragma once

#include "tracking.hpp"

namespace quadcore::control {

/// Tracking control on SE(3) (Lee, Leok, McClamroch, CDC 2010) with a quaternion attitude error and
/// feed-forward of the reference.
class Geometric final : public WrenchController {
 public:
  using Gains = TrackingGains;
  static const Settings<Gains>& settings();

  Geometric(const ModelledVehicle& model, const Gains& gains) : tracking_(model, gains) {}

  static constexpr std::size_t memory_size = size_of<GeometricMemory>;
  Feeds feeds() const override { return tracking_.feeds(); }
  Demand demand(const ControllerInput& input, double* memory) const override;
  std::shared_ptr<const LaneWrenchController> in_lanes(double period) const override;

 private:
  Tracking tracking_;
};

}  // namespace quadcore::control
