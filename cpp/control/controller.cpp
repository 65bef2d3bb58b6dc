#include "quadcore/control/controller.hpp"

namespace quadcore::control {

std::vector<TagSpec> Controller::table(const std::string& law) {
  const LawInfo& info = law_info(law);
  std::vector<TagSpec> table = info.table;
  for (const std::vector<TagSpec>& more : {Actuation::table(), Belief::table()}) {
    table.insert(table.end(), more.begin(), more.end());
  }
  return with_defaults(std::move(table), info.defaults);
}

Values Controller::completed_for(const std::string& law, const Values& values) {
  check_values("law '" + law + "'", table(law), values);
  return completed(values, law_info(law).defaults);
}

Controller::Controller(const std::string& law, const VehicleDescription& vehicle,
                       const Values& given, const std::vector<double>& spins)
    : Controller(law_info(law), vehicle, completed_for(law, given), spins) {}

Controller::Controller(const LawInfo& law, const VehicleDescription& vehicle, const Values& values,
                       const std::vector<double>& spins)
    : belief_(Belief::of(vehicle, spins, values)),
      actuation_(belief_, values),
      law_(law.make(belief_, values)) {}

void Controller::command(double period, const Odometry& now, const Reference& reference,
                         double* state, double* speeds) const {
  Reference wanted = reference;
  if (!actuation_.keeps_yaw(belief_.mass * belief_.gravity, state)) {
    wanted.yaw = rpy_from_quaternion(now.orientation).z();
    wanted.yaw_rate = wanted.yaw_acceleration = 0;
  }
  const Actuation::Now rotors_now = actuation_.now(state, speeds);
  const Instant instant{period,         rotors_now.begins,   now, wanted, rotors_now.exerted,
                        rotors_now.h_F, rotors_now.saturated};
  const Demand demand = law_->demand(instant, state + Actuation::state_size(rotors()));
  actuation_.command(period, demand, state, speeds);
}

}  // namespace quadcore::control
