#include "indi.hpp"

#include <string>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {
namespace {

/// Force, roll and pitch are measured here instead of modelled.
Settings<Indi::Gains> of_what_is_measured(Settings<Indi::Gains> settings) {
  for (Setting<Indi::Gains>& setting : settings) {
    std::string& meaning = setting.spec.meaning;
    if (setting.spec.name == "drag") {
      meaning = "compensates the modelled torque about z and the flat state; the rest is measured";
    } else if (setting.spec.name == "gyroscopic") {
      meaning = "compensates the rotors' gyroscopic torque about z; the other axes are measured";
    }
  }
  return settings;
}

}  // namespace

const Settings<Indi::Gains>& Indi::settings() {
  static const Settings<Gains> all = of_what_is_measured(with_tracking<Gains>(
      {{TagSpec::number(
            "filter", "rad/s", "40",
            "cut-off frequency of the filters on the accelerations and the rotors' wrench")
            .above(0),
        &Gains::filter}}));
  return all;
}

Demand Indi::demand(const LawInput& input, double* memory) const {
  const ModelledVehicle& model = tracking_.model();
  const Odometry& now = input.now;
  const Vector3d z_W = now.orientation * Vector3d::UnitZ();
  const std::optional<FlatState> flat = tracking_.fed_forward(input);
  const Vector3d a_W = tracking_.acceleration(input, memory + kIntegral);
  const auto filtered = [memory](std::size_t at) { return Eigen::Map<Vector3d>(memory + at); };

  const double share = 1 - elementary::exp(-filter_ * input.period);
  if (input.begins) {  // start with modelled values, including the accelerations, before the first
                       // measurement
    const Vector3d f_W = tracking_.force_W(input, flat, a_W);
    const Vector3d dw_F = tracking_.angular_acceleration(input, flat, f_W);
    const Demand demand{f_W.dot(z_W), tracking_.torque(input, dw_F)};
    const double behind = input.period * (1 / share - 1);  // lag of a filter on a ramp
    filtered(kVelocity) = now.linear_velocity - behind * a_W;
    filtered(kRate) = now.angular_velocity - behind * dw_F;
    filtered(kForce) = demand.thrust * z_W;
    filtered(kTorque) = demand.torque_F;
    return demand;
  }
  // The same filter for all signals, so that the compared values have the same delay.
  const auto follow = [&](std::size_t at, const Vector3d& x) -> Vector3d {
    const Vector3d change = share * (x - filtered(at));
    filtered(at) += change;
    return change / input.period;
  };
  const Vector3d measured_a_W = follow(kVelocity, now.linear_velocity);
  const Vector3d measured_dw_F = follow(kRate, now.angular_velocity);
  follow(kForce, input.exerted.thrust * z_W);
  follow(kTorque, input.exerted.torque_F);

  // Both accelerations refer to the origin of F; the force already includes the relative
  // acceleration of the centre of mass.
  const Vector3d f_W = filtered(kForce) + model.mass * (a_W - measured_a_W);
  const Vector3d dw_F = tracking_.angular_acceleration(input, flat, f_W);
  Demand demand{f_W.dot(z_W), tracking_.torque(input, dw_F)};
  const Vector3d incremental_F = filtered(kTorque) + model.inertia_Ccm_F * (dw_F - measured_dw_F);
  demand.torque_F.head<2>() = incremental_F.head<2>();
  return demand;
}

}  // namespace quadcore::control
