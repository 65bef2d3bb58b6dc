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
      {T::number("scale", "", "1", "factor of all gains").above(0).from("6.2"), &G::scale},
      {gain("kp_xy", "1/s^2", "2.4", "of the position along x and y", "(2.43)"), &G::kp_xy},
      {gain("ki_xy", "1/s^3", "0", "of its integral", "6.2"), &G::ki_xy},
      {gain("kd_xy", "1/s", "2.5", "of the velocity along x and y", "(2.43)"), &G::kd_xy},
      {gain("kp_z", "1/s^2", "2.4", "of the position along z", "(2.43)"), &G::kp_z},
      {gain("ki_z", "1/s^3", "0", "of its integral", "6.2"), &G::ki_z},
      {gain("kd_z", "1/s", "11.25", "of the velocity along z", "(2.43)"), &G::kd_z},
      {gain("kp_rp", "1/s^2", "96", "of roll and pitch", "(2.50)"), &G::kp_rp},
      {gain("ki_rp", "1/s^3", "0", "of their integral", "6.2"), &G::ki_rp},
      {gain("kd_rp", "1/s", "16", "of their rates", "(2.50)"), &G::kd_rp},
      {gain("kp_yaw", "1/s^2", "2", "of yaw", "(2.50)"), &G::kp_yaw},
      {gain("ki_yaw", "1/s^3", "0", "of its integral", "6.2"), &G::ki_yaw},
      {gain("kd_yaw", "1/s", "3", "of its rate", "(2.50)"), &G::kd_yaw},
      {T::flag("feed_forward", "true", "the acceleration of the reference").from("(2.43)"),
       &G::feed_forward},
      {T::flag("drag", "false", "makes up for the believed force and torque of the air")
           .from("(2.52)-(2.57)"),
       &G::drag},
      {T::flag("gyroscopic", "false", "makes up for the rotors' gyroscopic torque").from("(2.57)"),
       &G::gyroscopic},
      {T::flag(
           "flat_rates", "false",
           "rates of roll and pitch, and accelerations of all angles, that the reference asks for"),
       &G::flat_rates},
  };
  return all;
}

Cascade::Cascade(const Belief& belief, const Gains& gains) : belief_(belief), gains_(gains) {
  const Gains& g = gains_;
  outer_p_ = g.scale * Vector3d(g.kp_xy, g.kp_xy, g.kp_z);
  outer_i_ = g.scale * Vector3d(g.ki_xy, g.ki_xy, g.ki_z);
  outer_d_ = g.scale * Vector3d(g.kd_xy, g.kd_xy, g.kd_z);
  inner_p_ = g.scale * Vector3d(g.kp_rp, g.kp_rp, g.kp_yaw);
  inner_i_ = g.scale * Vector3d(g.ki_rp, g.ki_rp, g.ki_yaw);
  inner_d_ = g.scale * Vector3d(g.kd_rp, g.kd_rp, g.kd_yaw);
}

Demand Cascade::demand(const Instant& instant, double* memory) const {
  const Odometry& now = instant.now;
  const Matrix3d R_WF = now.orientation.toRotationMatrix();
  const Vector3d rpy = rpy_from_quaternion(now.orientation);

  std::optional<FlatState> flat;
  if (gains_.flat_rates) flat = flat_state(instant.wanted, belief_, gains_.drag);

  // U* + g e3 (2.56): what the rotors must exert per mass, in W.
  Vector3d lift_W = acceleration(instant, memory) + Vector3d(0, 0, belief_.gravity);
  if (flat) lift_W += flat->a_FCcm_W;
  if (gains_.drag) {
    lift_W -= belief_.air_force_W(R_WF, now.linear_velocity, now.angular_velocity) / belief_.mass;
  }

  // (2.46), (2.47) or (2.53), (2.54), with the measured yaw. Of four quadrants, so that a demand to
  // fall faster than freely turns the vehicle over instead of the demand.
  const auto [s_yaw, c_yaw] = elementary::sincos(rpy.z());
  const double size = lift_W.norm();
  const double pitch = elementary::atan2(lift_W.x() * c_yaw + lift_W.y() * s_yaw, lift_W.z());
  const double sine = size > 0 ? (lift_W.x() * s_yaw - lift_W.y() * c_yaw) / size : 0;
  const double roll = elementary::asin(std::clamp(sine, -1.0, 1.0));
  // (2.48) or (2.55).
  const double thrust = belief_.mass * lift_W.dot(R_WF.col(2));
  return {thrust, torque(instant, flat, rpy, {roll, pitch, instant.wanted.yaw}, memory)};
}

/// (2.43), with an integral as in section 6.2.
Vector3d Cascade::acceleration(const Instant& instant, double* memory) const {
  const Reference& wanted = instant.wanted;
  const Vector3d error = wanted.position - instant.now.position;
  auto integral = vector(memory + kPosition);
  integral += instant.period * error;
  Vector3d a_W = outer_p_.cwiseProduct(error) + outer_i_.cwiseProduct(integral) +
                 outer_d_.cwiseProduct(wanted.velocity - instant.now.linear_velocity);
  if (gains_.feed_forward) a_W += wanted.acceleration;
  return a_W;
}

/// (2.49), (2.50) or (2.57). J(eta) y + C(eta, eta') eta' are generalised torques, W^T times those
/// about the body's axes, which with J = W^T I W are I (W y + W' eta') + w x I w.
Vector3d Cascade::torque(const Instant& instant, const std::optional<FlatState>& flat,
                         const Vector3d& rpy, const Vector3d& wanted_rpy, double* memory) const {
  const Vector3d& w_WF_F = instant.now.angular_velocity;
  const Vector3d rates = rates_of(rpy, w_WF_F);
  const EulerRates of_now = euler_rates(rpy, rates);

  Vector3d error = wanted_rpy - rpy;
  error = error.unaryExpr([](double angle) { return wrapped(angle); });
  auto integral = vector(memory + kAngles);
  integral += instant.period * error;
  // eta_d' of (2.50): that of yaw the reference says, those of roll and pitch its flat state.
  Vector3d wanted_rates(0, 0, instant.wanted.yaw_rate);
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
    tau_air_F = belief_.air_torque_F(
        instant.now.orientation.conjugate() * instant.now.linear_velocity, w_WF_F);
  }
  const Vector3d h_F = gains_.gyroscopic ? instant.h_F : Vector3d(Vector3d::Zero());
  return torque_for(belief_, of_now.W * y + of_now.dW * rates, w_WF_F, h_F, tau_air_F);
}

}  // namespace quadcore::control
