#include "firmware/crazyflie_pid.hpp"

#include "firmware/units.hpp"
#include "lanes/turn.hpp"

namespace quadcore::control {
namespace {

constexpr double position_period = 0.01;  // s
constexpr double most_torque = 32767;     // counts of the roll, pitch and yaw outputs
constexpr double thrust_scale = 1000;     // counts per unit of the vertical velocity loop
constexpr double overhead = 1.1;          // of limits that an inner limit follows
constexpr double slowest_climb = 0.5;     // m/s, minimum of the vertical velocity limit
constexpr double position_limit = 5000;   // of integrals of position and velocity errors

/// Return kp e + ki sum, and grow the sum within its limit.
double update_pi(double kp, double ki, double error, double period, double limit, double& sum) {
  sum = clamp_within(sum + error * period, limit);
  return kp * error + ki * sum;
}

}  // namespace

const Settings<CrazyfliePid::Gains>& CrazyfliePid::settings() {
  using G = Gains;
  const auto gain = firmware_gain;
  static const Settings<G> all = {
      {gain("pos_xy_kp", "1/s", "2", "velocity per position error along x and y", "PID_POS_X_KP"),
       &G::pos_xy_kp},
      {gain("pos_xy_max", "m/s", "1",
            "velocity along x and y from which it is limited, at 1.1 "
            "times this value",
            "PID_POS_VEL_X_MAX"),
       &G::pos_xy_max},
      {gain("pos_z_kp", "1/s", "2", "velocity per position error along z", "PID_POS_Z_KP"),
       &G::pos_z_kp},
      {gain("pos_z_ki", "1/s^2", "0.5", "velocity per integral of the position error along z",
            "PID_POS_Z_KI"),
       &G::pos_z_ki},
      {gain("pos_z_max", "m/s", "1",
            "velocity along z from which it is limited, at 1.1 times this "
            "value",
            "PID_POS_VEL_Z_MAX"),
       &G::pos_z_max},
      {gain("vel_xy_kp", "deg s/m", "25", "tilt per velocity error along x and y", "PID_VEL_X_KP"),
       &G::vel_xy_kp},
      {gain("vel_xy_ki", "deg/m", "1", "tilt per integral of the velocity error along x and y",
            "PID_VEL_X_KI"),
       &G::vel_xy_ki},
      {gain("vel_tilt_max", "deg", "20", "maximum roll and pitch", "PID_VEL_ROLL_MAX"),
       &G::vel_tilt_max},
      {gain("vel_z_kp", "s/m", "25", "thousands of counts per velocity error along z",
            "PID_VEL_Z_KP"),
       &G::vel_z_kp},
      {gain("vel_z_ki", "1/m", "15",
            "thousands of counts per integral of the velocity error along "
            "z",
            "PID_VEL_Z_KI"),
       &G::vel_z_ki},
      {gain("thrust_base", "", "36000", "thrust command without errors, in counts",
            "PID_VEL_THRUST_BASE"),
       &G::thrust_base},
      {gain("thrust_min", "", "20000", "minimum thrust command, in counts", "PID_VEL_THRUST_MIN"),
       &G::thrust_min},
      {gain("hover_count", "", "36000",
            "command of each motor, in counts, at which the modelled vehicle hovers", "")
           .above(0),
       &G::hover_count},
      {gain("att_rp_kp", "1/s", "6", "rate per roll and pitch error", "PID_ROLL_KP"),
       &G::att_rp_kp},
      {gain("att_rp_ki", "1/s^2", "3", "rate per integral of the roll and pitch errors",
            "PID_ROLL_KI"),
       &G::att_rp_ki},
      {gain("att_rp_limit", "deg s", "20", "maximum integral of the roll and pitch errors",
            "PID_ROLL_INTEGRATION_LIMIT"),
       &G::att_rp_limit},
      {gain("att_yaw_kp", "1/s", "6", "rate per yaw error", "PID_YAW_KP"), &G::att_yaw_kp},
      {gain("att_yaw_ki", "1/s^2", "1", "rate per integral of the yaw error", "PID_YAW_KI"),
       &G::att_yaw_ki},
      {gain("att_yaw_kd", "", "0.35", "rate per rate of the measured yaw", "PID_YAW_KD"),
       &G::att_yaw_kd},
      {gain("att_yaw_limit", "deg s", "360", "maximum integral of the yaw error",
            "PID_YAW_INTEGRATION_LIMIT"),
       &G::att_yaw_limit},
      {gain("rate_rp_kp", "s/deg", "250", "counts per roll and pitch rate error",
            "PID_ROLL_RATE_KP"),
       &G::rate_rp_kp},
      {gain("rate_rp_ki", "1/deg", "500", "counts per integral of the roll and pitch rate errors",
            "PID_ROLL_RATE_KI"),
       &G::rate_rp_ki},
      {gain("rate_rp_kd", "s^2/deg", "2.5", "counts per angular acceleration about x and y",
            "PID_ROLL_RATE_KD"),
       &G::rate_rp_kd},
      {gain("rate_rp_limit", "deg", "33.3", "maximum integral of the roll and pitch rate errors",
            "PID_ROLL_RATE_INTEGRATION_LIMIT"),
       &G::rate_rp_limit},
      {gain("rate_yaw_kp", "s/deg", "120", "counts per yaw rate error", "PID_YAW_RATE_KP"),
       &G::rate_yaw_kp},
      {gain("rate_yaw_ki", "1/deg", "16.7", "counts per integral of the yaw rate error",
            "PID_YAW_RATE_KI"),
       &G::rate_yaw_ki},
      {gain("rate_yaw_limit", "deg", "166.7", "maximum integral of the yaw rate error",
            "PID_YAW_RATE_INTEGRATION_LIMIT"),
       &G::rate_yaw_limit},
  };
  return all;
}

CrazyfliePid::CrazyfliePid(const ModelledVehicle& model, const Gains& gains)
    : gains_(gains), mix_(model, gains.hover_count, crazyflie_full, 1) {}

Demand CrazyfliePid::demand(const ControllerInput& input, double* numbers) const {
  auto& memory = memory_as<Memory>(numbers);
  const Gains& g = gains_;
  const Vector3d rpy = rpy_from_quaternion(input.now.orientation);
  const Vector3d angles = degrees_per_radian * rpy;
  const Vector3d rates = degrees_per_radian * input.now.angular_velocity;
  if (input.begins) {
    memory.waited = position_period;
    memory.last_yaw = angles.z();
    std::copy_n(rates.data(), 2, memory.last_rates);
  } else {
    memory.waited += input.period;
  }
  if (memory.waited >= position_period - 1e-9) {
    follow_position(input, rpy.z(), memory.waited, memory);
    memory.waited = 0;
  }
  const double period = input.period;
  const double yaw_error = degrees_per_radian * laws::within_half_turn(input.wanted.yaw - rpy.z());
  const double yaw_change = std::remainder(angles.z() - memory.last_yaw, 360);
  memory.last_yaw = angles.z();
  double* const sum = memory.att_sum;
  const Vector3d wanted(
      update_pi(g.att_rp_kp, g.att_rp_ki, memory.roll - angles.x(), period, g.att_rp_limit, sum[0]),
      update_pi(g.att_rp_kp, g.att_rp_ki, memory.pitch - angles.y(), period, g.att_rp_limit,
                sum[1]),
      update_pi(g.att_yaw_kp, g.att_yaw_ki, yaw_error, period, g.att_yaw_limit, sum[2]) -
          g.att_yaw_kd * yaw_change / period);
  double outputs[3];
  for (int i = 0; i < 2; ++i) {
    outputs[i] = update_pi(g.rate_rp_kp, g.rate_rp_ki, wanted[i] - rates[i], period,
                           g.rate_rp_limit, memory.rate_sum[i]) -
                 g.rate_rp_kd * (rates[i] - memory.last_rates[i]) / period;
    memory.last_rates[i] = rates[i];
  }
  outputs[2] = update_pi(g.rate_yaw_kp, g.rate_yaw_ki, wanted.z() - rates.z(), period,
                         g.rate_yaw_limit, memory.rate_sum[2]);
  for (double& output : outputs) output = clamp_within(output, most_torque);
  // The firmware adds half of the roll and pitch outputs to the motors of an X.
  return mix_.demand({memory.thrust, M_SQRT1_2 * outputs[0], M_SQRT1_2 * outputs[1], outputs[2]});
}

/// Set roll, pitch and thrust from the errors of position and velocity, in axes of the yaw.
void CrazyfliePid::follow_position(const ControllerInput& input, double yaw, double period,
                                   Memory& memory) const {
  const Gains& g = gains_;
  const auto [s, c] = elementary::sincos(yaw);
  const auto turned = [s = s, c = c](const Vector3d& v) {
    return Vector3d(c * v.x() + s * v.y(), c * v.y() - s * v.x(), v.z());
  };
  const Vector3d error = turned(input.wanted.position - input.now.position);
  const double fastest_xy = overhead * g.pos_xy_max;
  const double fastest_z = overhead * std::max(g.pos_z_max, slowest_climb);
  const double climb =
      update_pi(g.pos_z_kp, g.pos_z_ki, error.z(), period, position_limit, memory.pos_z_sum);
  const Vector3d wanted(clamp_within(g.pos_xy_kp * error.x(), fastest_xy),
                        clamp_within(g.pos_xy_kp * error.y(), fastest_xy),
                        clamp_within(climb, fastest_z));
  const Vector3d slip = wanted - turned(input.now.linear_velocity);
  double* const sum = memory.vel_sum;
  const double forward =
      update_pi(g.vel_xy_kp, g.vel_xy_ki, slip.x(), period, position_limit, sum[0]);
  const double left = update_pi(g.vel_xy_kp, g.vel_xy_ki, slip.y(), period, position_limit, sum[1]);
  const double up = update_pi(g.vel_z_kp, g.vel_z_ki, slip.z(), period, position_limit, sum[2]);
  memory.pitch = clamp_within(forward, g.vel_tilt_max);
  memory.roll = -clamp_within(left, g.vel_tilt_max);
  const double most_change = crazyflie_full / 2;
  memory.thrust = std::min(
      crazyflie_full,
      std::max(g.thrust_min, g.thrust_base + clamp_within(thrust_scale * up, most_change)));
}

}  // namespace quadcore::control
