#include "quadcore/control/actuation.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

struct Lead {
  bool lead;
  double time;
};

const Settings<Lead>& lead_settings() {
  static const Settings<Lead> all = {
      {T::flag("lead", "true", "whether the lag of the motors is inverted"), &Lead::lead},
      {T::number("lead_time", "s", "0.01", "time constant that is left of it").above(0),
       &Lead::time},
  };
  return all;
}

}  // namespace

const std::vector<TagSpec>& Actuation::table() {
  static const std::vector<TagSpec> all = table_of(lead_settings());
  return all;
}

Actuation::Actuation(const Belief& belief, const Values& values)
    : rotors_(belief.rotors), allocation_(belief) {
  Lead lead{};
  configure(lead, lead_settings(), values);
  leads_ = lead.lead;
  lead_time_ = lead.time;
}

Actuation::Now Actuation::now(const double* state, double* scratch) const {
  const double* const believed = state + kRotors;
  Now now{state[kBegun] == 0, saturated(state), {}, Vector3d::Zero()};
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    const BelievedRotor& rotor = rotors_[i];
    now.h_F += rotor.momentum * rotor.spin * believed[i] * rotor.axis_F;
    scratch[i] = believed[i] * believed[i];
  }
  now.exerted = allocation_.exerted(scratch, lost(state));
  return now;
}

void Actuation::command(double period, const Demand& demand, double* state, double* speeds) const {
  const bool met = allocation_.allocate(demand, speeds, lost(state));
  for (std::size_t i = 0; i < rotors_.size(); ++i) speeds[i] = std::sqrt(speeds[i]);
  const bool reached = lead(period, state[kBegun] == 0, state, speeds);
  for (std::size_t i = 0; i < rotors_.size(); ++i) speeds[i] *= rotors_[i].spin;
  state[kBegun] = 1;
  state[kSaturated] = met && reached ? 0 : 1;
}

bool Actuation::keeps_yaw(double thrust, const double* state) const {
  const double* const lost_now = lost(state);
  const bool are_whole =
      std::all_of(lost_now, lost_now + rotors_.size(), [](double share) { return share == 0; });
  return are_whole || allocation_.keeps_yaw(thrust, lost_now);
}

/// Makes commands of wanted speeds and follows what the rotors make of them: speeds that approach a
/// command with their lag tau, dw/dt = (command - w)/tau, approach the wanted speed with lead_time.
/// Says whether the commands can be followed.
bool Actuation::lead(double period, bool begins, double* state, double* speeds) const {
  constexpr double rounding = 1e-6;  // rad/s
  double* const believed = state + kRotors;
  bool all = true;
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    const BelievedRotor& rotor = rotors_[i];
    if (begins) believed[i] = speeds[i];
    if (rotor.lag == 0 || lost(state)[i] == 1) {
      believed[i] = speeds[i];
      continue;
    }
    const double share = 1 - elementary::exp(-period / rotor.lag);  // of the way, in a period
    if (leads_ && lead_time_ < rotor.lag) {
      const double wanted_share = 1 - elementary::exp(-period / lead_time_);
      const double ahead = believed[i] + wanted_share / share * (speeds[i] - believed[i]);
      speeds[i] = std::clamp(ahead, rotor.slowest, rotor.fastest);
      all &= std::abs(speeds[i] - ahead) <= rounding;
    }
    believed[i] += share * (speeds[i] - believed[i]);
  }
  return all;
}

}  // namespace quadcore::control
