#include "cascade.hpp"

#include <algorithm>
#include <cmath>

#include "euler_rates.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

T gain(const char* name, const char* unit, const char* fallback, const char* meaning,
       const char* equation) {
  return T::number(name, unit, fallback, meaning).at_least(0).from(equation);
}

Eigen::Map<Vector3d> vector(double* numbers) { return Eigen::Map<Vector3d>(numbers); }

}  // namespace

const Settings<Cascade::Gains>& Cascade::settings() {
  using G = Gains;
  static const Settings<G> all = {
      {T::number("scale", "", "1", "factor applied to all gains").above(0).from("6.2"), &G::scale},
      {gain("kp_xy", "1/s^2", "2.4", "gain of the position error along x and y", "(2.43)"),
       &G::kp_xy},
      {gain("ki_xy", "1/s^3", "0", "gain of the integral of the position error along x and y",
            "6.2"),
       &G::ki_xy},
      {gain("kd_xy", "1/s", "2.5", "gain of the velocity error along x and y", "(2.43)"),
       &G::kd_xy},
      {gain("kp_z", "1/s^2", "2.4", "gain of the position error along z", "(2.43)"), &G::kp_z},
      {gain("ki_z", "1/s^3", "0", "gain of the integral of the position error along z", "6.2"),
       &G::ki_z},
      {gain("kd_z", "1/s", "11.25", "gain of the velocity error along z", "(2.43)"), &G::kd_z},
      {gain("kp_rp", "1/s^2", "96", "gain of the roll and pitch errors", "(2.50)"), &G::kp_rp},
      {gain("ki_rp", "1/s^3", "0", "gain of the integrals of the roll and pitch errors", "6.2"),
       &G::ki_rp},
      {gain("kd_rp", "1/s", "16", "gain of the roll and pitch rate errors", "(2.50)"), &G::kd_rp},
      {gain("kp_yaw", "1/s^2", "2", "gain of the yaw error", "(2.50)"), &G::kp_yaw},
      {gain("ki_yaw", "1/s^3", "0", "gain of the integral of the yaw error", "6.2"), &G::ki_yaw},
      {gain("kd_yaw", "1/s", "3", "gain of the yaw rate error", "(2.50)"), &G::kd_yaw},
      {T::flag("feed_forward", "true", "feeds the reference's acceleration forward").from("(2.43)"),
       &G::feed_forward},
      {T::flag("drag", "false", "compensates the modelled aerodynamic force and torque")
           .from("(2.52)-(2.57)"),
       &G::drag},
      {T::flag("gyroscopic", "false", "compensates the rotors' gyroscopic torque").from("(2.57)"),
       &G::gyroscopic},
      {T::flag("flat_rates", "false",
               "feeds the reference's roll and pitch rates and all angular accelerations forward"),
       &G::flat_rates},
  };
  return all;
}

Cascade::Cascade(const ModelledVehicle& model, const Gains& gains) : model_(model), gains_(gains) {
  const Gains& g = gains_;
  outer_p_ = g.scale * Vector3d(g.kp_xy, g.kp_xy, g.kp_z);
  outer_i_ = g.scale * Vector3d(g.ki_xy, g.ki_xy, g.ki_z);
  outer_d_ = g.scale * Vector3d(g.kd_xy, g.kd_xy, g.kd_z);
  inner_p_ = g.scale * Vector3d(g.kp_rp, g.kp_rp, g.kp_yaw);
  inner_i_ = g.scale * Vector3d(g.ki_rp, g.ki_rp, g.ki_yaw);
  inner_d_ = g.scale * Vector3d(g.kd_rp, g.kd_rp, g.kd_yaw);
}

Demand Cascade::demand(const ControllerInput& input, double* memory) const {
  const Odometry& now = input.now;
  const Matrix3d R_WF = now.orientation.toRotationMatrix();
  const Vector3d rpy = rpy_from_quaternion(now.orientation);

  std::optional<FlatState> flat;
  if (gains_.flat_rates) {
    flat = input.flat ? *input.flat : flat_state(input.wanted, model_, gains_.drag);
  }

  // U* + g e3 (2.56): required force of the rotors per mass, in W.
  Vector3d lift_W = acceleration(input, memory) + Vector3d(0, 0, model_.gravity);
  if (flat) lift_W += flat->a_FCcm_W;
  if (gains_.drag) {
    lift_W -= model_.air_force_W(R_WF, now.linear_velocity, now.angular_velocity) / model_.mass;
  }

  // (2.46), (2.47) or (2.53), (2.54), with the measured yaw. The four-quadrant arc tangent makes a
  // demand beyond free fall turn the vehicle over instead of reversing the demand.
  const auto [s_yaw, c_yaw] = elementary::sincos(rpy.z());
  const double size = lift_W.norm();
  const double pitch = elementary::atan2(lift_W.x() * c_yaw + lift_W.y() * s_yaw, lift_W.z());
  const double sine = size > 0 ? (lift_W.x() * s_yaw - lift_W.y() * c_yaw) / size : 0;
  const double roll = elementary::asin(std::clamp(sine, -1.0, 1.0));
  // (2.48) or (2.55).
  const double thrust = model_.mass * lift_W.dot(R_WF.col(2));
  return {thrust, torque(input, flat, rpy, {roll, pitch, input.wanted.yaw}, memory)};
}

/// Return the acceleration of (2.43), with an integral as in section 6.2.
Vector3d Cascade::acceleration(const ControllerInput& input, double* memory) const {
  const Reference& wanted = input.wanted;
  const Vector3d error = wanted.position - input.now.position;
  auto integral = vector(memory + kPosition);
  integral += input.period * error;
  Vector3d a_W = outer_p_.cwiseProduct(error) + outer_i_.cwiseProduct(integral) +
                 outer_d_.cwiseProduct(wanted.velocity - input.now.linear_velocity);
  if (gains_.feed_forward) a_W += wanted.acceleration;
  return a_W;
}

/// Return the torque of (2.49), (2.50) or (2.57). J(eta) y + C(eta, eta') eta' are generalised
/// torques, W^T times those about the body axes. With J = W^T I W, the latter are I (W y + W' eta')
/// + w x I w.
Vector3d Cascade::torque(const ControllerInput& input, const std::optional<FlatState>& flat,
                         const Vector3d& rpy, const Vector3d& wanted_rpy, double* memory) const {
  const Vector3d& w_WF_F = input.now.angular_velocity;
  const Vector3d rates = rates_of(rpy, w_WF_F);
  const EulerRates of_now = euler_rates(rpy, rates);

  Vector3d error = wanted_rpy - rpy;
  error = error.unaryExpr([](double angle) { return wrap_angle(angle); });
  auto integral = vector(memory + kAngles);
  integral += input.period * error;
  // eta_d' of (2.50): the yaw rate comes from the reference, the others from its flat state.
  Vector3d wanted_rates(0, 0, input.wanted.yaw_rate);
  Vector3d wanted_accelerations = Vector3d::Zero();
  if (flat) {
    const Vector3d flat_rpy = rpy_from_quaternion(Quaterniond(flat->R_WF));
    wanted_rates = rates_of(flat_rpy, flat->w_WF_F);
    const EulerRates of_flat = euler_rates(flat_rpy, wanted_rates);
    // W eta'' = w' - W' eta', and rates_of() divides by W.
    wanted_accelerations = rates_of(flat_rpy, flat->dw_WF_F - of_flat.dW * wanted_rates);
  }
  const Vector3d y = inner_p_.cwiseProduct(error) + inner_i_.cwiseProduct(integral) +
                     inner_d_.cwiseProduct(wanted_rates - rates) + wanted_accelerations;
  Vector3d tau_air_F = Vector3d::Zero();
  if (gains_.drag) {
    tau_air_F =
        model_.air_torque_F(input.now.orientation.conjugate() * input.now.linear_velocity, w_WF_F);
  }
  const Vector3d h_F = gains_.gyroscopic ? input.h_F : Vector3d(Vector3d::Zero());
  return torque_for(model_, of_now.W * y + of_now.dW * rates, w_WF_F, h_F, tau_air_F);
}

}  // namespace quadcore::control
