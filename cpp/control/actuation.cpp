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
      {T::flag("lead", "true", "whether to compensate the motors' lag"), &Lead::lead},
      {T::number("lead_time", "s", "0.01", "time constant that remains after the compensation")
           .above(0),
       &Lead::time},
  };
  return all;
}

}  // namespace

const std::vector<TagSpec>& Actuation::table() {
  static const std::vector<TagSpec> all = table_of(lead_settings());
  return all;
}

Actuation::Actuation(const ModelledVehicle& model, const Values& values)
    : rotors_(model.rotors), allocation_(model) {
  Lead lead{};
  configure(lead, lead_settings(), values);
  leads_ = lead.lead;
  lead_time_ = lead.time;
}

Actuation::Now Actuation::now(const double* state, double* scratch) const {
  const double* const modelled = state + kRotors;
  Now now{state[kBegun] == 0, saturated(state), {}, Vector3d::Zero()};
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    const ModelledRotor& rotor = rotors_[i];
    now.h_F += rotor.momentum * rotor.spin * modelled[i] * rotor.axis_F;
    scratch[i] = modelled[i] * modelled[i];
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

bool Actuation::can_control_yaw(double thrust, const double* state) const {
  const double* const lost_now = lost(state);
  const bool are_whole =
      std::all_of(lost_now, lost_now + rotors_.size(), [](double share) { return share == 0; });
  return are_whole || allocation_.can_control_yaw(thrust, lost_now);
}

/// Turn wanted speeds into commands and update the modelled speeds. Rotors approach a command with
/// their lag tau, dw/dt = (command - w)/tau; the commands make them approach the wanted speed with
/// lead_time. Returns whether the commands are within the limits.
bool Actuation::lead(double period, bool begins, double* state, double* speeds) const {
  constexpr double rounding = 1e-6;  // rad/s
  double* const modelled = state + kRotors;
  bool all = true;
  if (period != state[kPeriod]) find_shares(period, state);
  const double wanted_share = state[kWantedShare];
  const double* const shares = lost(state) + rotors_.size();
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    const ModelledRotor& rotor = rotors_[i];
    if (begins) modelled[i] = speeds[i];
    if (rotor.lag == 0 || lost(state)[i] == 1) {
      modelled[i] = speeds[i];
      continue;
    }
    if (leads_ && lead_time_ < rotor.lag) {
      const double ahead = modelled[i] + wanted_share / shares[i] * (speeds[i] - modelled[i]);
      speeds[i] = std::clamp(ahead, rotor.slowest, rotor.fastest);
      all &= std::abs(speeds[i] - ahead) <= rounding;
    }
    modelled[i] += shares[i] * (speeds[i] - modelled[i]);
  }
  return all;
}

void Actuation::find_shares(double period, double* state) const {
  double* const shares = state + kRotors + 2 * rotors_.size();
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    const double lag = rotors_[i].lag;
    shares[i] = lag > 0 ? 1 - elementary::exp(-period / lag) : 1;
  }
  state[kWantedShare] = leads_ ? 1 - elementary::exp(-period / lead_time_) : 0;
  state[kPeriod] = period;
}

}  // namespace quadcore::control
