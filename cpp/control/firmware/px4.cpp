#include "firmware/px4.hpp"

#include "firmware/units.hpp"
#include "quadcore/control/flat_state.hpp"

namespace quadcore::control {
namespace {

constexpr double px4_gravity = 9.80665;     // m/s^2, CONSTANTS_ONE_G
constexpr double least_thrust = 10e-4;      // for a direction of the thrust
constexpr double large_rate_error = 400.0;  // deg/s, from which the integral stands still
constexpr double opposite = 1e-5;           // 1 - |x| or 1 - |y| of a turn by half a circle

/// Return first + second, shortened to a length: the first part has priority.
Eigen::Vector2d add_within(const Eigen::Vector2d& first, const Eigen::Vector2d& second,
                           double most) {
  const Eigen::Vector2d sum = first + second;
  if (sum.norm() <= most) return sum;
  if (first.norm() >= most) return most * first.normalized();
  // |first + s u| = most has the positive root s.
  const Eigen::Vector2d u = second.normalized();
  const double along = u.dot(first);
  return first + u * (std::sqrt(along * along + most * most - first.squaredNorm()) - along);
}

/// Return the shortest rotation between two unit vectors.
Quaterniond rotation_between(const Vector3d& from, const Vector3d& to) {
  const Vector3d cross = from.cross(to);
  const double w = 1 + from.dot(to);
  if (w > 1e-12) return Quaterniond(w, cross.x(), cross.y(), cross.z()).normalized();
  const Vector3d axis = from.unitOrthogonal();
  return Quaterniond(0, axis.x(), axis.y(), axis.z());
}

}  // namespace

const Settings<Px4::Gains>& Px4::settings() {
  using G = Gains;
  const auto gain = [](const char* name, const char* unit, const char* fallback,
                       const char* meaning) {
    return firmware_gain(name, unit, fallback, meaning, "");
  };
  static const Settings<G> all = {
      {gain("mpc_xy_p", "1/s", "0.95", "velocity per position error along x and y"), &G::mpc_xy_p},
      {gain("mpc_z_p", "1/s", "1", "velocity per position error along z"), &G::mpc_z_p},
      {gain("mpc_xy_vel_p_acc", "1/s", "1.8", "acceleration per velocity error along x and y"),
       &G::mpc_xy_vel_p_acc},
      {gain("mpc_xy_vel_i_acc", "1/s^2", "0.4",
            "acceleration per integral of the velocity error along x and y"),
       &G::mpc_xy_vel_i_acc},
      {gain("mpc_xy_vel_d_acc", "", "0.2", "acceleration per measured acceleration along x and y"),
       &G::mpc_xy_vel_d_acc},
      {gain("mpc_z_vel_p_acc", "1/s", "4", "acceleration per velocity error along z"),
       &G::mpc_z_vel_p_acc},
      {gain("mpc_z_vel_i_acc", "1/s^2", "2",
            "acceleration per integral of the velocity error along z"),
       &G::mpc_z_vel_i_acc},
      {gain("mpc_z_vel_d_acc", "", "0", "acceleration per measured acceleration along z"),
       &G::mpc_z_vel_d_acc},
      {gain("mpc_xy_vel_max", "m/s", "12", "maximum horizontal velocity"), &G::mpc_xy_vel_max},
      {gain("mpc_z_vel_max_up", "m/s", "3", "maximum velocity of climbs"), &G::mpc_z_vel_max_up},
      {gain("mpc_z_vel_max_dn", "m/s", "1", "maximum velocity of descents"), &G::mpc_z_vel_max_dn},
      {gain("mpc_tiltmax_air", "deg", "45", "maximum tilt").at_most(89), &G::mpc_tiltmax_air},
      {gain("mpc_thr_hover", "", "0.5", "motor command at which the modelled vehicle hovers")
           .above(0)
           .at_most(1),
       &G::mpc_thr_hover},
      {gain("mpc_thr_min", "", "0.12", "minimum thrust command").at_most(1), &G::mpc_thr_min},
      {gain("mpc_thr_max", "", "1", "maximum thrust command").at_most(1), &G::mpc_thr_max},
      {gain("mpc_veld_lp", "Hz", "5", "cut-off frequency of the measured acceleration"),
       &G::mpc_veld_lp},
      {gain("mc_rp_p", "1/s", "6.5", "rate per roll and pitch error (MC_ROLL_P, MC_PITCH_P)"),
       &G::mc_rp_p},
      {gain("mc_yaw_p", "1/s", "2.8", "rate per yaw error"), &G::mc_yaw_p},
      {gain("mc_yaw_weight", "", "0.4", "weight of the yaw error against roll and pitch errors")
           .above(0)
           .at_most(1),
       &G::mc_yaw_weight},
      {gain("mc_rprate_max", "deg/s", "220", "maximum roll and pitch rates"), &G::mc_rprate_max},
      {gain("mc_yawrate_max", "deg/s", "200", "maximum yaw rate"), &G::mc_yawrate_max},
      {gain("mc_rprate_p", "s", "0.15",
            "torque per roll and pitch rate error (MC_ROLLRATE_P, MC_PITCHRATE_P)"),
       &G::mc_rprate_p},
      {gain("mc_rprate_i", "", "0.2", "torque per integral of the roll and pitch rate errors"),
       &G::mc_rprate_i},
      {gain("mc_rprate_d", "s^2", "0.003", "torque per angular acceleration about x and y"),
       &G::mc_rprate_d},
      {gain("mc_yawrate_p", "s", "0.2", "torque per yaw rate error"), &G::mc_yawrate_p},
      {gain("mc_yawrate_i", "", "0.1", "torque per integral of the yaw rate error"),
       &G::mc_yawrate_i},
      {gain("mc_yawrate_d", "s^2", "0", "torque per angular acceleration about z"),
       &G::mc_yawrate_d},
      {gain("mc_rate_int_lim", "", "0.3", "maximum torque by an integral (MC_RR_INT_LIM)"),
       &G::mc_rate_int_lim},
      {gain("imu_dgyro_cutoff", "Hz", "30", "cut-off frequency of the angular acceleration")
           .above(0),
       &G::imu_dgyro_cutoff},
  };
  return all;
}

Px4::Px4(const ModelledVehicle& model, const Gains& gains)
    : gains_(gains), mix_(model, gains.mpc_thr_hover, 1, 2) {}

Demand Px4::demand(const ControllerInput& input, double* numbers) const {
  auto& memory = memory_as<Memory>(numbers);
  if (input.begins) {
    Eigen::Map<Vector3d>(memory.last_velocity) = input.now.linear_velocity;
    Eigen::Map<Vector3d>(memory.last_rates) = input.now.angular_velocity;
  }
  const Vector3d f_W = thrust_W(input, memory);
  const Vector3d tau = torque(input, wanted_rates(input, f_W), memory);
  return mix_.demand({f_W.norm(), tau.x(), tau.y(), tau.z()});
}

Vector3d Px4::wanted_velocity(const ControllerInput& input) const {
  const Gains& g = gains_;
  const Vector3d& ahead = input.wanted.velocity;
  const Vector3d back = Vector3d(g.mpc_xy_p, g.mpc_xy_p, g.mpc_z_p)
                            .cwiseProduct(input.wanted.position - input.now.position);
  Vector3d velocity;
  velocity.head<2>() = add_within(back.head<2>(), ahead.head<2>(), g.mpc_xy_vel_max);
  velocity.z() = std::clamp(back.z() + ahead.z(), -g.mpc_z_vel_max_dn, g.mpc_z_vel_max_up);
  return velocity;
}

/// Return the wanted thrust as a vector of motor commands, in W.
Vector3d Px4::thrust_W(const ControllerInput& input, Memory& memory) const {
  const Gains& g = gains_;
  const Vector3d kp(g.mpc_xy_vel_p_acc, g.mpc_xy_vel_p_acc, g.mpc_z_vel_p_acc);
  const Vector3d ki(g.mpc_xy_vel_i_acc, g.mpc_xy_vel_i_acc, g.mpc_z_vel_i_acc);
  const Vector3d kd(g.mpc_xy_vel_d_acc, g.mpc_xy_vel_d_acc, g.mpc_z_vel_d_acc);
  Eigen::Map<Vector3d> sum(memory.velocity_sum), last(memory.last_velocity);
  Eigen::Map<Vector3d> measured(memory.acceleration);
  const double lag = 2 * M_PI * g.mpc_veld_lp * input.period;
  measured += lag / (1 + lag) * ((input.now.linear_velocity - last) / input.period - measured);
  last = input.now.linear_velocity;

  Vector3d slip = wanted_velocity(input) - input.now.linear_velocity;
  const Vector3d a_W =
      input.wanted.acceleration + kp.cwiseProduct(slip) + sum - kd.cwiseProduct(measured);
  const double tilt = std::min(elementary::atan2(a_W.head<2>().norm(), px4_gravity),
                               g.mpc_tiltmax_air / degrees_per_radian);
  const auto [s, c] = elementary::sincos(tilt);
  Vector3d z_W(0, 0, c);
  if (s > 0) z_W.head<2>() = s * a_W.head<2>().normalized();
  const double least = std::max(g.mpc_thr_min, least_thrust);
  const double collective =
      std::max(least, (a_W.z() / px4_gravity + 1) * g.mpc_thr_hover / z_W.z());
  Vector3d thrust = collective * z_W;

  // The vertical integral stands still at the limits of the thrust.
  if ((thrust.z() <= least && slip.z() <= 0) || (thrust.z() >= g.mpc_thr_max && slip.z() >= 0)) {
    slip.z() = 0;
  }
  // The vertical thrust has priority.
  thrust.z() = std::min(thrust.z(), g.mpc_thr_max);
  const double left =
      std::sqrt(std::max(0.0, g.mpc_thr_max * g.mpc_thr_max - thrust.z() * thrust.z()));
  const double wide = thrust.head<2>().norm();
  if (wide > left) thrust.head<2>() *= left / wide;
  // Anti-windup by tracking (L. Rundqwist, "Anti-reset windup for PID controllers", 1990).
  if (g.mpc_xy_vel_p_acc > 0) {
    const Eigen::Vector2d reached = thrust.head<2>() * (px4_gravity / g.mpc_thr_hover);
    slip.head<2>() -= 2 / g.mpc_xy_vel_p_acc * (a_W.head<2>() - reached);
  }
  sum += input.period * ki.cwiseProduct(slip);
  sum.z() = clamp_within(sum.z(), px4_gravity);
  return thrust;
}

/// Return the angular velocity that turns z of F to a direction, and x towards the yaw with less
/// weight, in F [rad/s].
Vector3d Px4::wanted_rates(const ControllerInput& input, const Vector3d& thrust_W) const {
  const Gains& g = gains_;
  const Quaterniond& q_WF = input.now.orientation;
  const Vector3d z_W = thrust_W.normalized();
  Matrix3d R_WD;
  R_WD.col(2) = z_W;
  R_WD.col(0) = across_yaw(input.wanted.yaw).cross(z_W).normalized();
  R_WD.col(1) = z_W.cross(R_WD.col(0));
  const Quaterniond q_WD(R_WD);
  // The shortest turn of z, then the turn about z with the weight.
  const Quaterniond reduction = rotation_between(q_WF * Vector3d(0, 0, 1), z_W);
  const bool is_opposite =
      std::abs(reduction.x()) > 1 - opposite || std::abs(reduction.y()) > 1 - opposite;
  const Quaterniond q_WR = is_opposite ? q_WD : reduction * q_WF;
  const Quaterniond about_z = q_WR.conjugate() * q_WD;
  const double half = std::remainder(elementary::atan2(about_z.z(), about_z.w()), M_PI);
  const auto [s, c] = elementary::sincos(g.mc_yaw_weight * half);
  const Quaterniond q_FD = q_WF.conjugate() * (q_WR * Quaterniond(c, 0, 0, s));
  const Vector3d kp(g.mc_rp_p, g.mc_rp_p, g.mc_yaw_p / g.mc_yaw_weight);
  const Vector3d limit =
      Vector3d(g.mc_rprate_max, g.mc_rprate_max, g.mc_yawrate_max) / degrees_per_radian;
  const Vector3d rates = (q_FD.w() < 0 ? -2.0 : 2.0) * kp.cwiseProduct(q_FD.vec()) +
                         q_WF.conjugate() * Vector3d(0, 0, input.wanted.yaw_rate);
  return rates.cwiseMin(limit).cwiseMax(-limit);
}

/// Return the torque outputs for an angular velocity.
Vector3d Px4::torque(const ControllerInput& input, const Vector3d& wanted, Memory& memory) const {
  const Gains& g = gains_;
  const Vector3d kp(g.mc_rprate_p, g.mc_rprate_p, g.mc_yawrate_p);
  const Vector3d ki(g.mc_rprate_i, g.mc_rprate_i, g.mc_yawrate_i);
  const Vector3d kd(g.mc_rprate_d, g.mc_rprate_d, g.mc_yawrate_d);
  const LowPass filter(g.imu_dgyro_cutoff, input.period);
  Vector3d torque;
  for (int i = 0; i < 3; ++i) {
    const double rate = input.now.angular_velocity[i];
    const double error = wanted[i] - rate;
    const double change = (rate - memory.last_rates[i]) / input.period;
    memory.last_rates[i] = rate;
    torque[i] =
        kp[i] * error + memory.rate_sum[i] - kd[i] * filter.apply(change, memory.rate_filters[i]);
    const double relative = degrees_per_radian * error / large_rate_error;
    const double share = std::max(0.0, 1 - relative * relative);
    memory.rate_sum[i] =
        clamp_within(memory.rate_sum[i] + share * ki[i] * error * input.period, g.mc_rate_int_lim);
  }
  return torque;
}

}  // namespace quadcore::control
