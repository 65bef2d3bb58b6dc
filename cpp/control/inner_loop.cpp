#include "quadcore/control/inner_loop.hpp"

#include "attitude_settings.hpp"

namespace quadcore::control {
namespace {

const Settings<AttitudeGains>& attitude_settings() {
  static const Settings<AttitudeGains> all = with_attitude<AttitudeGains>({});
  return all;
}

AttitudeGains gains_of(const Values& values) {
  AttitudeGains gains{};
  configure(gains, attitude_settings(), values);
  return gains;
}

const Values& checked(const Values& values) {
  check_values("inner loop", InnerLoop::table(), values);
  return values;
}

}  // namespace

const std::vector<TagSpec>& InnerLoop::table() {
  static const std::vector<TagSpec> all = [] {
    std::vector<TagSpec> table = table_of(attitude_settings());
    for (const std::vector<TagSpec>& more : {Actuation::table(), ModelledVehicle::table()}) {
      table.insert(table.end(), more.begin(), more.end());
    }
    return table;
  }();
  return all;
}

InnerLoop::InnerLoop(const VehicleDescription& vehicle, const Values& values,
                     const std::vector<double>& spins)
    : InnerLoop(ModelledVehicle::of(vehicle, spins, checked(values)), values) {}

InnerLoop::InnerLoop(const ModelledVehicle& model, const Values& values)
    : loop_(model, gains_of(values)), actuation_(model, values) {}

void InnerLoop::command(double period, const Odometry& now, const AttitudeThrust& wanted,
                        double* state, double* speeds) const {
  const Quaterniond q_FD = now.orientation.conjugate() * wanted.orientation;
  command(period, now, wanted.thrust, loop_.angular_acceleration(q_FD, -now.angular_velocity),
          state, speeds);
}

void InnerLoop::command(double period, const Odometry& now, const RatesThrust& wanted,
                        double* state, double* speeds) const {
  command(period, now, wanted.thrust,
          loop_.angular_acceleration(wanted.w_WF_F - now.angular_velocity), state, speeds);
}

void InnerLoop::command(double period, const Odometry&, const WrenchThrust& wanted, double* state,
                        double* speeds) const {
  actuation_.command(period, Demand{wanted.thrust, wanted.torque_F}, state, speeds);
}

void InnerLoop::command(double period, const Odometry& now, double thrust, const Vector3d& dw_WF_F,
                        double* state, double* speeds) const {
  const Actuation::Now rotors_now = actuation_.now(state);
  const Demand demand{thrust, loop_.torque(now, rotors_now.h_F, dw_WF_F)};
  actuation_.command(period, demand, state, speeds);
}

}  // namespace quadcore::control
