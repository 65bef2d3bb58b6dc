#include "indi.hpp"

#include <string>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {
namespace {

/// What the model says of force, roll and pitch is measured here.
Settings<Indi::Gains> of_what_is_measured(Settings<Indi::Gains> settings) {
  for (Setting<Indi::Gains>& setting : settings) {
    std::string& meaning = setting.spec.meaning;
    if (setting.spec.name == "drag") {
      meaning =
          "makes up for the believed torque of the air about z, and bends the reference's "
          "flat state; the rest is measured";
    } else if (setting.spec.name == "gyroscopic") {
      meaning = "makes up for the rotors' gyroscopic torque about z; the rest is measured";
    }
  }
  return settings;
}

}  // namespace

const Settings<Indi::Gains>& Indi::settings() {
  static const Settings<Gains> all = of_what_is_measured(with_tracking<Gains>(
      {{TagSpec::number(
            "filter", "rad/s", "40",
            "bandwidth up to which accelerations and what the rotors exert are compared")
            .above(0),
        &Gains::filter}}));
  return all;
}

Demand Indi::demand(const Instant& instant, double* memory) const {
  const Belief& belief = tracking_.belief();
  const Odometry& now = instant.now;
  const Vector3d z_W = now.orientation * Vector3d::UnitZ();
  const std::optional<FlatState> flat = tracking_.fed_forward(instant);
  const Vector3d a_W = tracking_.acceleration(instant, memory + kIntegral);
  const auto filtered = [memory](std::size_t at) { return Eigen::Map<Vector3d>(memory + at); };

  const double share = 1 - elementary::exp(-filter_ * instant.period);
  if (instant.begins) {  // nothing was measured yet: as the model has it, accelerations included
    const Vector3d f_W = tracking_.force_W(instant, flat, a_W);
    const Vector3d dw_F = tracking_.angular_acceleration(instant, flat, f_W);
    const Demand demand{f_W.dot(z_W), tracking_.torque(instant, dw_F)};
    const double behind = instant.period * (1 / share - 1);  // a filter is that of a ramp
    filtered(kVelocity) = now.linear_velocity - behind * a_W;
    filtered(kRate) = now.angular_velocity - behind * dw_F;
    filtered(kForce) = demand.thrust * z_W;
    filtered(kTorque) = demand.torque_F;
    return demand;
  }
  // One filter for all, so that what is compared is of one age.
  const auto follow = [&](std::size_t at, const Vector3d& x) -> Vector3d {
    const Vector3d change = share * (x - filtered(at));
    filtered(at) += change;
    return change / instant.period;
  };
  const Vector3d measured_a_W = follow(kVelocity, now.linear_velocity);
  const Vector3d measured_dw_F = follow(kRate, now.angular_velocity);
  follow(kForce, instant.exerted.thrust * z_W);
  follow(kTorque, instant.exerted.torque_F);

  // Both accelerations are those of the origin of F: what the centre of mass has beside them is in
  // the force already.
  const Vector3d f_W = filtered(kForce) + belief.mass * (a_W - measured_a_W);
  const Vector3d dw_F = tracking_.angular_acceleration(instant, flat, f_W);
  Demand demand{f_W.dot(z_W), tracking_.torque(instant, dw_F)};
  const Vector3d incremental_F = filtered(kTorque) + belief.inertia_Ccm_F * (dw_F - measured_dw_F);
  demand.torque_F.head<2>() = incremental_F.head<2>();
  return demand;
}

}  // namespace quadcore::control
