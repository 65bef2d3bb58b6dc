#include "quadcore/control/controller.hpp"

#include "lane_controller.hpp"

namespace quadcore::control {

std::vector<TagSpec> Controller::table(const std::string& name) {
  const ControllerInfo& info = find_controller(name);
  std::vector<TagSpec> table = info.table;
  for (const std::vector<TagSpec>& more : {Actuation::table(), ModelledVehicle::table()}) {
    table.insert(table.end(), more.begin(), more.end());
  }
  return with_defaults(std::move(table), info.defaults);
}

Values Controller::complete_values(const std::string& name, const Values& values) {
  check_values("controller '" + name + "'", table(name), values);
  return complete(values, find_controller(name).defaults);
}

Controller::Controller(const std::string& name, const VehicleDescription& vehicle,
                       const Values& given, const std::vector<double>& spins)
    : Controller(find_controller(name), vehicle, complete_values(name, given), spins) {}

Controller::Controller(const ControllerInfo& info, const VehicleDescription& vehicle,
                       const Values& values, const std::vector<double>& spins)
    : model_(ModelledVehicle::of(vehicle, spins, values)),
      actuation_(model_, values),
      wrench_controller_(info.make(model_, values)),
      memory_size_(info.memory_size) {}

void Controller::command(double period, const Odometry& now, const Reference& wanted, double* state,
                         double* speeds, const FlatState* flat) const {
  if (actuation_.can_control_yaw(model_.mass * model_.gravity, state)) {
    return follow(period, now, wanted, flat, state, speeds);
  }
  Reference at_any_yaw = wanted;
  at_any_yaw.yaw = rpy_from_quaternion(now.orientation).z();
  at_any_yaw.yaw_rate = at_any_yaw.yaw_acceleration = 0;
  follow(period, now, at_any_yaw, nullptr, state, speeds);
}

void Controller::follow(double period, const Odometry& now, const Reference& wanted,
                        const FlatState* flat, double* state, double* speeds) const {
  const Actuation::Now rotors_now = actuation_.now(state);
  const ControllerInput input{
      period,         rotors_now.begins,   now, wanted, flat, rotors_now.exerted,
      rotors_now.h_F, rotors_now.saturated};
  const Demand demand = wrench_controller_->demand(input, state + Actuation::state_size(rotors()));
  actuation_.command(period, demand, state, speeds);
}

std::shared_ptr<const LaneController> Controller::in_lanes(double period) const {
  const std::shared_ptr<const LaneWrenchController> in_lanes = wrench_controller_->in_lanes(period);
  if (!in_lanes) return nullptr;
  LaneController made{*in_lanes, rotors(), actuation_.list_numbers(),
                      std::vector<double>(state_size())};
  actuation_.set_period(period, made.state.data());
  return std::make_shared<LaneController>(std::move(made));
}

}  // namespace quadcore::control
