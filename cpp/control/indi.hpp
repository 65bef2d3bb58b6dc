#pragma once

#include "tracking.hpp"

namespace quadcore::control {

/// Incremental nonlinear dynamic inversion (Smeur, Chu, de Croon, JGCD 2016; Tal, Karaman, IEEE
/// TCST 2021). Instead of computing the demand from the model, it adds the difference between
/// wanted and measured accelerations to the present wrench of the rotors. Yaw uses the model,
/// because the rotors' acceleration acts on it first.
class Indi final : public WrenchController {
 public:
  struct Gains : TrackingGains {
    double filter;
  };
  static const Settings<Gains>& settings();
  static constexpr std::size_t memory_size = size_of<IndiMemory>;

  Indi(const ModelledVehicle& model, const Gains& gains)
      : tracking_(model, gains), filter_(gains.filter) {}

  Feeds feeds() const override { return tracking_.feeds(); }
  Demand demand(const ControllerInput& input, double* memory) const override;
  std::shared_ptr<const LaneWrenchController> in_lanes(double period) const override;

 private:
  /// Return the fraction of a change that the filters pass within a period.
  double filter_share(double period) const;

  Tracking tracking_;
  double filter_;
};

}  // namespace quadcore::control
