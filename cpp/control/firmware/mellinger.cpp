#include "firmware/mellinger.hpp"

#include <optional>

#include "firmware/units.hpp"
#include "quadcore/control/flat_state.hpp"

namespace quadcore::control {
namespace {

constexpr double mass_of_gains = 0.029;  // kg, CF_MASS
constexpr double standard_gravity = 9.81;
constexpr double mellinger_most_torque = 32000;  // counts

}  // namespace

const Settings<Mellinger::Gains>& Mellinger::settings() {
  using G = Gains;
  const auto gain = firmware_gain;
  static const Settings<G> all = {
      {gain("force_xy_kp", "N/m", "0.4", "force per position error along x and y at 29 g",
            "ctrlMel.kp_xy"),
       &G::force_xy_kp},
      {gain("force_xy_ki", "N/(m s)", "0.05",
            "force per integral of the position error along x and y at 29 g", "ctrlMel.ki_xy"),
       &G::force_xy_ki},
      {gain("force_xy_kd", "N s/m", "0.2", "force per velocity error along x and y at 29 g",
            "ctrlMel.kd_xy"),
       &G::force_xy_kd},
      {gain("force_xy_limit", "m s", "2", "maximum integral along x and y", "ctrlMel.i_range_xy"),
       &G::force_xy_limit},
      {gain("force_z_kp", "N/m", "1.25", "force per position error along z at 29 g",
            "ctrlMel.kp_z"),
       &G::force_z_kp},
      {gain("force_z_ki", "N/(m s)", "0.05",
            "force per integral of the position error along z at 29 g", "ctrlMel.ki_z"),
       &G::force_z_ki},
      {gain("force_z_kd", "N s/m", "0.4", "force per velocity error along z at 29 g",
            "ctrlMel.kd_z"),
       &G::force_z_kd},
      {gain("force_z_limit", "m s", "0.4", "maximum integral along z", "ctrlMel.i_range_z"),
       &G::force_z_limit},
      {gain("moment_xy_kr", "", "70000", "counts per attitude error about x and y",
            "ctrlMel.kR_xy"),
       &G::moment_xy_kr},
      {gain("moment_xy_kw", "s", "20000", "counts per angular velocity error about x and y",
            "ctrlMel.kw_xy"),
       &G::moment_xy_kw},
      {gain("moment_xy_kd", "s^2", "200", "counts per angular acceleration error about x and y",
            "ctrlMel.kd_omega_rp"),
       &G::moment_xy_kd},
      {gain("moment_z_kr", "", "60000", "counts per attitude error about z", "ctrlMel.kR_z"),
       &G::moment_z_kr},
      {gain("moment_z_kw", "s", "12000", "counts per angular velocity error about z",
            "ctrlMel.kw_z"),
       &G::moment_z_kw},
      {gain("moment_z_ki", "1/s", "500", "counts per integral of the attitude error about z",
            "ctrlMel.ki_m_z"),
       &G::moment_z_ki},
      {gain("moment_z_limit", "s", "1500", "maximum integral of the attitude error about z",
            "ctrlMel.i_range_m_z"),
       &G::moment_z_limit},
      {gain("mass_thrust", "1/N", "132000", "counts of every motor per thrust at 29 g",
            "ctrlMel.massThrust")
           .above(0),
       &G::mass_thrust},
  };
  return all;
}

Mellinger::Mellinger(const ModelledVehicle& model, const Gains& gains)
    : model_(model),
      gains_(gains),
      hover_(gains.mass_thrust * mass_of_gains * standard_gravity),
      mix_(model, hover_, crazyflie_full, 1) {}

Demand Mellinger::demand(const ControllerInput& input, double* numbers) const {
  auto& memory = memory_as<Memory>(numbers);
  const Gains& g = gains_;
  std::optional<FlatState> computed;
  const FlatState& flat =
      input.flat ? *input.flat : computed.emplace(flat_state(input.wanted, model_, false));
  const Vector3d f_W = force_W(input, memory);
  const Matrix3d R_WF = input.now.orientation.toRotationMatrix();
  Matrix3d R_WD;
  R_WD.col(2) = f_W.normalized();
  const auto [s, c] = elementary::sincos(input.wanted.yaw);
  R_WD.col(1) = R_WD.col(2).cross(Vector3d(c, s, 0)).normalized();
  R_WD.col(0) = R_WD.col(1).cross(R_WD.col(2));
  const Matrix3d R_DF = R_WD.transpose() * R_WF;
  // Twice the error e_R of Mellinger and Kumar.
  const Vector3d error(R_DF(2, 1) - R_DF(1, 2), R_DF(0, 2) - R_DF(2, 0), R_DF(1, 0) - R_DF(0, 1));
  const Vector3d slip = flat.w_WF_F - input.now.angular_velocity;
  if (input.begins) std::copy_n(slip.data(), 2, memory.last_error);
  memory.yaw_sum = clamp_within(memory.yaw_sum - error.z() * input.period, g.moment_z_limit);
  double outputs[3];
  for (int i = 0; i < 2; ++i) {
    outputs[i] = -g.moment_xy_kr * error[i] + g.moment_xy_kw * slip[i] +
                 g.moment_xy_kd * (slip[i] - memory.last_error[i]) / input.period;
    memory.last_error[i] = slip[i];
  }
  outputs[2] =
      -g.moment_z_kr * error.z() + g.moment_z_kw * slip.z() + g.moment_z_ki * memory.yaw_sum;
  for (double& output : outputs) output = clamp_within(output, mellinger_most_torque);
  const double counts = hover_ * f_W.dot(R_WF.col(2)) / (model_.mass * model_.gravity);
  if (!(counts > 0)) {
    memory = {};
    return {};
  }
  return mix_.demand({counts, M_SQRT1_2 * outputs[0], M_SQRT1_2 * outputs[1], outputs[2]});
}

/// Return the wanted force of the rotors in W [N].
Vector3d Mellinger::force_W(const ControllerInput& input, Memory& memory) const {
  const Gains& g = gains_;
  const Vector3d error = input.wanted.position - input.now.position;
  const Vector3d limit(g.force_xy_limit, g.force_xy_limit, g.force_z_limit);
  Eigen::Map<Vector3d> sum(memory.position_sum);
  sum = (sum + input.period * error).cwiseMin(limit).cwiseMax(-limit);
  const Vector3d kp(g.force_xy_kp, g.force_xy_kp, g.force_z_kp);
  const Vector3d ki(g.force_xy_ki, g.force_xy_ki, g.force_z_ki);
  const Vector3d kd(g.force_xy_kd, g.force_xy_kd, g.force_z_kd);
  const Vector3d back = kp.cwiseProduct(error) + ki.cwiseProduct(sum) +
                        kd.cwiseProduct(input.wanted.velocity - input.now.linear_velocity);
  return model_.mass *
         (input.wanted.acceleration + Vector3d(0, 0, model_.gravity) + back / mass_of_gains);
}

}  // namespace quadcore::control
