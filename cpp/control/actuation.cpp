#include "quadcore/control/actuation.hpp"

#include <algorithm>
#include <cmath>

#include "actuation_formulas.hpp"
#include "numbers.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {

/// Compensation of the motors' lag.
struct MotorLead {
  bool lead;
  double time;  ///< that remains, s
};

namespace {

using T = TagSpec;

const Settings<MotorLead>& lead_settings() {
  static const Settings<MotorLead> all = {
      {T::flag("lead", "true", "whether to compensate the motors' lag"), &MotorLead::lead},
      {T::number("lead_time", "s", "0.01", "time constant that remains after the compensation")
           .above(0),
       &MotorLead::time},
  };
  return all;
}

}  // namespace

using Row = ActuationRow;

/// Numbers of each rotor, and the time constants.
struct Actuation::Numbers {
  std::vector<RotorNumbers<double>> rotors;
  std::vector<double> lags;  ///< s
  MotorLead lead;
};

const std::vector<TagSpec>& Actuation::table() {
  static const std::vector<TagSpec> all = table_of(lead_settings());
  return all;
}

Actuation::Actuation(const ModelledVehicle& model, const Values& values) : allocation_(model) {
  auto numbers = std::make_shared<Numbers>();
  configure(numbers->lead, lead_settings(), values);
  for (std::size_t i = 0; i < model.rotors.size(); ++i) {
    const ModelledRotor& rotor = model.rotors[i];
    const bool leads = numbers->lead.lead && numbers->lead.time < rotor.lag;
    const Vector3d h_F = rotor.momentum * rotor.spin * rotor.axis_F;
    numbers->rotors.push_back({numbers_of(h_F), rotor.spin, rotor.lag > 0 ? 1.0 : 0.0,
                               leads ? 1.0 : 0.0, rotor.slowest, rotor.fastest,
                               allocation_.rotor(i)});
    numbers->lags.push_back(rotor.lag);
  }
  numbers_ = std::move(numbers);
}

std::size_t Actuation::state_size(std::size_t rotors) { return Row::count(rotors); }

bool Actuation::saturated(const double* state) { return state[Row::saturated] != 0; }

bool Actuation::has_begun(const double* state) { return state[Row::begun] != 0; }

void Actuation::set_remaining(std::size_t rotor, double left, double* state) const {
  state[Row::lost(numbers_->rotors.size()) + rotor] = 1 - left;
}

const double* Actuation::lost(const double* state) const {
  return state + Row::lost(numbers_->rotors.size());
}

Actuation::Now Actuation::now(const double* state) const {
  RotorsNumbers<double> now{};
  const std::vector<RotorNumbers<double>>& rotors = numbers_->rotors;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const double speed = state[Row::speeds + i];
    add_momentum(rotors[i], speed, now.h_F);
    add_wrench(rotors[i].allocated, speed * speed, 1 - lost(state)[i], now.exerted);
  }
  return {!has_begun(state), saturated(state), demand_of(now.exerted), vector_of(now.h_F)};
}

void Actuation::command(double period, const Demand& demand, double* state, double* speeds) const {
  const std::vector<RotorNumbers<double>>& rotors = numbers_->rotors;
  const bool met = allocation_.allocate(demand, speeds, lost(state));
  for (std::size_t i = 0; i < rotors.size(); ++i) speeds[i] = std::sqrt(speeds[i]);
  const bool reached = lead(period, state, speeds);
  for (std::size_t i = 0; i < rotors.size(); ++i) speeds[i] *= rotors[i].spin;
  state[Row::begun] = 1;
  state[Row::saturated] = met && reached ? 0 : 1;
}

std::vector<double> Actuation::list_numbers() const {
  std::vector<double> numbers;
  for (const RotorNumbers<double>& rotor : numbers_->rotors) {
    const std::vector<double> of_rotor = control::list_numbers(rotor);
    numbers.insert(numbers.end(), of_rotor.begin(), of_rotor.end());
  }
  return numbers;
}

bool Actuation::are_whole(const double* state) const {
  const double* const lost_now = lost(state);
  return std::all_of(lost_now, lost_now + numbers_->rotors.size(),
                     [](double share) { return share == 0; });
}

bool Actuation::can_control_yaw(double thrust, const double* state) const {
  return are_whole(state) || allocation_.can_control_yaw(thrust, lost(state));
}

/// Turn wanted speeds into commands and update the modelled speeds. Returns whether the commands
/// are within the limits.
bool Actuation::lead(double period, double* state, double* speeds) const {
  const std::vector<RotorNumbers<double>>& rotors = numbers_->rotors;
  double* const modelled = state + Row::speeds;
  set_period(period, state);
  const double* const shares = state + Row::shares(rotors.size());
  bool all = true;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const bool stands = lost(state)[i] == 1;
    if (stands || !has_begun(state)) modelled[i] = speeds[i];
    if (stands) continue;
    const LedNumbers<double> led =
        control::lead(rotors[i], speeds[i], modelled[i], state[Row::wanted_share], shares[i]);
    all &= led.excess <= largest_excess;
    speeds[i] = led.command;
    modelled[i] = led.modelled;
  }
  return all;
}

void Actuation::set_period(double period, double* state) const {
  if (period == state[Row::period]) return;
  const MotorLead& lead = numbers_->lead;
  double* const shares = state + Row::shares(numbers_->rotors.size());
  for (std::size_t i = 0; i < numbers_->rotors.size(); ++i) {
    const double lag = numbers_->lags[i];
    shares[i] = lag > 0 ? 1 - elementary::exp(-period / lag) : 1;
  }
  state[Row::wanted_share] = lead.lead ? 1 - elementary::exp(-period / lead.time) : 0;
  state[Row::period] = period;
}

}  // namespace quadcore::control
