#pragma once

#include <optional>

#include "quadcore/control/flat_state.hpp"
#include "quadcore/control/wrench_controller.hpp"

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
  static constexpr std::size_t memory_size = 6;

  Cascade(const ModelledVehicle& model, const Gains& gains);

  Feeds feeds() const override {
    if (!gains_.flat_rates) return Feeds::nothing;
    return gains_.drag ? Feeds::flat_state_with_drag : Feeds::flat_state;
  }
  Demand demand(const ControllerInput& input, double* memory) const override;

 private:
  /// Integrals of the position and angle errors.
  enum : std::size_t { kPosition, kAngles = 3 };

  Vector3d acceleration(const ControllerInput& input, double* memory) const;
  Vector3d torque(const ControllerInput& input, const std::optional<FlatState>& flat,
                  const Vector3d& rpy, const Vector3d& wanted_rpy, double* memory) const;

  ModelledVehicle model_;
  Gains gains_;
  Vector3d outer_p_, outer_i_, outer_d_, inner_p_, inner_i_, inner_d_;
};

}  // namespace quadcore::control
