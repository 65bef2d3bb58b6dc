#include "cascade.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

T gain(const char* name, const char* unit, const char* fallback, const char* meaning,
       const char* equation) {
  return T::number(name, unit, fallback, meaning).at_least(0).from(equation);
}

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

Cascade::Cascade(const ModelledVehicle& model, const Gains& g)
    : model_(model), switches_{g.feed_forward, g.flat_rates, true, g.drag, g.gyroscopic} {
  const auto scaled = [&](double x, double y, double z) {
    return Vec3<double>{g.scale * x, g.scale * y, g.scale * z};
  };
  numbers_ = {scaled(g.kp_xy, g.kp_xy, g.kp_z),
              scaled(g.ki_xy, g.ki_xy, g.ki_z),
              scaled(g.kd_xy, g.kd_xy, g.kd_z),
              scaled(g.kp_rp, g.kp_rp, g.kp_yaw),
              scaled(g.ki_rp, g.ki_rp, g.ki_yaw),
              scaled(g.kd_rp, g.kd_rp, g.kd_yaw),
              numbers_of(model)};
}

WrenchController::Feeds Cascade::feeds() const {
  if (!switches_.flat_rates) return Feeds::nothing;
  return switches_.drag ? Feeds::flat_state_with_drag : Feeds::flat_state;
}

Demand Cascade::demand(const ControllerInput& input, double* memory) const {
  return call_with_numbers(input, feeds(), model_, [&](const InputNumbers<double>& numbers) {
    return demand_by_cascade(CascadeFormulas<double>{switches_, numbers_, numbers},
                             memory_of<CascadeMemory>(memory));
  });
}

std::shared_ptr<const LaneWrenchController> Cascade::in_lanes(double /*period*/) const {
  return std::make_shared<LaneWrenchController>(
      LaneWrenchController{ControllerKind::cascade, switches_, list_numbers(numbers_)});
}

}  // namespace quadcore::control
