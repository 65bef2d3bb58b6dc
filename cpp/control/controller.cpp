#include "quadcore/control/controller.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/elementary.hpp"
#include "quadcore/error.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

struct Lead {
  bool lead;
  double time;
};

const Settings<Lead>& settings() {
  static const Settings<Lead> all = {
      {T::flag("lead", "true", "whether the lag of the motors is inverted"), &Lead::lead},
      {T::number("lead_time", "s", "0.01", "time constant that is left of it").above(0),
       &Lead::time},
  };
  return all;
}

}  // namespace

std::vector<TagSpec> Controller::table(const std::string& law) {
  const LawInfo& info = law_info(law);
  std::vector<TagSpec> table = info.table;
  for (const std::vector<TagSpec>& more : {table_of(settings()), Belief::table()}) {
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
      allocation_(belief_),
      law_(law.make(belief_, values)) {
  Lead lead{};
  configure(lead, settings(), values);
  leads_ = lead.lead;
  lead_time_ = lead.time;
}

void Controller::command(double period, const Odometry& now, const Reference& wanted, double* state,
                         double* speeds) const {
  double* const believed = state + kRotors;
  const bool begins = state[kBegun] == 0;
  const Demand nothing;
  Instant instant{period, begins, now, wanted, nothing, Vector3d::Zero(), saturated(state)};
  for (std::size_t i = 0; i < rotors(); ++i) {
    const BelievedRotor& rotor = belief_.rotors[i];
    instant.h_F += rotor.momentum * rotor.spin * believed[i] * rotor.axis_F;
    speeds[i] = believed[i] * believed[i];
  }
  instant.exerted = allocation_.exerted(speeds);
  const Demand demand = law_->demand(instant, believed + rotors());
  const bool met = allocation_.allocate(demand, speeds);
  for (std::size_t i = 0; i < rotors(); ++i) speeds[i] = std::sqrt(speeds[i]);
  const bool reached = lead(period, begins, believed, speeds);
  for (std::size_t i = 0; i < rotors(); ++i) speeds[i] *= belief_.rotors[i].spin;
  state[kBegun] = 1;
  state[kSaturated] = met && reached ? 0 : 1;
}

/// Makes commands of wanted speeds and follows what the rotors make of them: speeds that approach a
/// command with their lag tau, dw/dt = (command - w)/tau, approach the wanted speed with lead_time.
/// Says whether the commands can be followed.
bool Controller::lead(double period, bool begins, double* believed, double* speeds) const {
  bool all = true;
  for (std::size_t i = 0; i < rotors(); ++i) {
    const BelievedRotor& rotor = belief_.rotors[i];
    if (begins) believed[i] = speeds[i];
    if (rotor.lag == 0) {
      believed[i] = speeds[i];
      continue;
    }
    const double share = 1 - elementary::exp(-period / rotor.lag);  // of the way, in a period
    if (leads_ && lead_time_ < rotor.lag) {
      const double wanted_share = 1 - elementary::exp(-period / lead_time_);
      const double ahead = believed[i] + wanted_share / share * (speeds[i] - believed[i]);
      speeds[i] = std::clamp(ahead, rotor.slowest, rotor.fastest);
      all &= speeds[i] == ahead;
    }
    believed[i] += share * (speeds[i] - believed[i]);
  }
  return all;
}

}  // namespace quadcore::control
