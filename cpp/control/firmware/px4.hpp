#pragma once

#include "firmware/low_pass.hpp"
#include "firmware/motor_mix.hpp"

namespace quadcore::control {

/// The multicopter cascade of PX4, written from its equations with its default gains (PX4/Firmware
/// 34160bb: src/modules/mc_pos_control/PositionControl, mc_att_control/AttitudeControl,
/// mc_rate_control/RateControl). Position errors give velocities, these give accelerations, a
/// thrust direction and thus an attitude, attitudes give rates (Brescianini, Hehn, D'Andrea, ETH
/// Zurich, 2013), and rates give normalised torques. Motor commands are 0 to 1, and the thrust of a
/// rotor is proportional to the squared command. All loops run at each call. The parameters have
/// the names of those of PX4.
class Px4 final : public WrenchController {
 public:
  struct Gains {
    double mpc_xy_p, mpc_z_p, mpc_xy_vel_p_acc, mpc_xy_vel_i_acc, mpc_xy_vel_d_acc;
    double mpc_z_vel_p_acc, mpc_z_vel_i_acc, mpc_z_vel_d_acc;
    double mpc_xy_vel_max, mpc_z_vel_max_up, mpc_z_vel_max_dn, mpc_tiltmax_air;
    double mpc_thr_hover, mpc_thr_min, mpc_thr_max, mpc_veld_lp;
    double mc_rp_p, mc_yaw_p, mc_yaw_weight, mc_rprate_max, mc_yawrate_max;
    double mc_rprate_p, mc_rprate_i, mc_rprate_d, mc_yawrate_p, mc_yawrate_i, mc_yawrate_d;
    double mc_rate_int_lim, imu_dgyro_cutoff;
  };
  static const Settings<Gains>& settings();

  Px4(const ModelledVehicle& model, const Gains& gains);

  struct Memory {
    double velocity_sum[3], rate_sum[3];
    double last_velocity[3], acceleration[3], last_rates[3];
    LowPassMemory rate_filters[3];
  };
  static constexpr std::size_t memory_size = sizeof(Memory) / sizeof(double);
  Demand demand(const ControllerInput& input, double* memory) const override;

 private:
  Vector3d wanted_velocity(const ControllerInput& input) const;
  Vector3d thrust_W(const ControllerInput& input, Memory& memory) const;
  Vector3d wanted_rates(const ControllerInput& input, const Vector3d& thrust_W) const;
  Vector3d torque(const ControllerInput& input, const Vector3d& wanted, Memory& memory) const;

  Gains gains_;
  MotorMix mix_;
};

}  // namespace quadcore::control
