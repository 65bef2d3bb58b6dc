#pragma once

#include "firmware/motor_mix.hpp"

namespace quadcore::control {

/// The controller of Mellinger and Kumar (ICRA 2011) as in the Crazyflie firmware, written from its
/// equations with its default gains (bitcraze/crazyflie-firmware 2a18fc2:
/// src/modules/src/controller/controller_mellinger.c). The forces of the firmware are for a vehicle
/// of 29 g. Here they are proportional to the modelled mass. Torques are motor commands in counts.
class Mellinger final : public WrenchController {
 public:
  struct Gains {
    double force_xy_kp, force_xy_ki, force_xy_kd, force_xy_limit;
    double force_z_kp, force_z_ki, force_z_kd, force_z_limit;
    double moment_xy_kr, moment_xy_kw, moment_xy_kd;
    double moment_z_kr, moment_z_kw, moment_z_ki, moment_z_limit, mass_thrust;
  };
  static const Settings<Gains>& settings();

  Mellinger(const ModelledVehicle& model, const Gains& gains);

  struct Memory {
    double position_sum[3], yaw_sum;
    double last_error[2];  ///< of the angular velocity about x and y [rad/s]
  };
  static constexpr std::size_t memory_size = sizeof(Memory) / sizeof(double);
  Feeds feeds() const override { return Feeds::flat_state; }
  Demand demand(const ControllerInput& input, double* memory) const override;

 private:
  Vector3d force_W(const ControllerInput& input, Memory& memory) const;

  ModelledVehicle model_;
  Gains gains_;
  double hover_;  ///< counts
  MotorMix mix_;
};

}  // namespace quadcore::control
