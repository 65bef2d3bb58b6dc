#pragma once

#include "firmware/motor_mix.hpp"

namespace quadcore::control {

/// The PID cascade of the Crazyflie firmware, written from its equations with its default gains
/// (bitcraze/crazyflie-firmware 2a18fc2: src/modules/src/controller/position_controller_pid.c,
/// attitude_pid_controller.c, src/utils/src/pid.c, src/platform/interface/platform_defaults_cf2.h).
/// Position errors give velocities, these give roll, pitch and thrust, angles give rates, and rates
/// give motor commands. Angles are in degrees, and commands in counts from 0 to 65535. The position
/// loop runs at 100 Hz, the rest at each call. Only position and yaw of the reference are used, as
/// by position set-points of the firmware.
class CrazyfliePid final : public WrenchController {
 public:
  struct Gains {
    double pos_xy_kp, pos_xy_max, pos_z_kp, pos_z_ki, pos_z_max;
    double vel_xy_kp, vel_xy_ki, vel_tilt_max, vel_z_kp, vel_z_ki, thrust_base, thrust_min,
        hover_count;
    double att_rp_kp, att_rp_ki, att_rp_limit, att_yaw_kp, att_yaw_ki, att_yaw_kd, att_yaw_limit;
    double rate_rp_kp, rate_rp_ki, rate_rp_kd, rate_rp_limit;
    double rate_yaw_kp, rate_yaw_ki, rate_yaw_limit;
  };
  static const Settings<Gains>& settings();

  CrazyfliePid(const ModelledVehicle& model, const Gains& gains);

  struct Memory {
    double waited;  ///< since the last call of the position loop [s]
    double roll, pitch, thrust;
    double pos_z_sum, vel_sum[3];
    double att_sum[3], rate_sum[3];
    double last_yaw, last_rates[2];
  };
  static constexpr std::size_t memory_size = sizeof(Memory) / sizeof(double);
  Demand demand(const ControllerInput& input, double* memory) const override;

 private:
  void follow_position(const ControllerInput& input, double yaw, double period,
                       Memory& memory) const;

  Gains gains_;
  MotorMix mix_;
};

}  // namespace quadcore::control
