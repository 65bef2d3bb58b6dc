#pragma once

#include "cascade_formulas.hpp"
#include "numbers.hpp"

namespace quadcore::control {

/// The cascaded controller of thesis chapter 2 with feedback linearisation. An outer position loop
/// commands roll, pitch and thrust; an inner loop on roll, pitch and yaw commands the torques.
/// Without compensation these are eqs. (2.43)-(2.51), with it (2.52)-(2.57), and with integrals the
/// PID of section 6.2.
class Cascade final : public WrenchController {
 public:
  struct Gains {
    double scale;
    double kp_xy, ki_xy, kd_xy, kp_z, ki_z, kd_z;
    double kp_rp, ki_rp, kd_rp, kp_yaw, ki_yaw, kd_yaw;
    bool feed_forward, drag, gyroscopic, flat_rates;
  };
  static const Settings<Gains>& settings();
  static constexpr std::size_t memory_size = size_of<CascadeMemory>;

  Cascade(const ModelledVehicle& model, const Gains& gains);

  Feeds feeds() const override;
  Demand demand(const ControllerInput& input, double* memory) const override;
  std::shared_ptr<const LaneWrenchController> in_lanes(double period) const override;

 private:
  ModelledVehicle model_;
  ControllerSwitches switches_;
  CascadeNumbers<double> numbers_;
};

}  // namespace quadcore::control
