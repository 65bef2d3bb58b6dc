#include "quadcore/control/belief.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "quadcore/control/rotors.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

/// What a belief makes of the truth.
struct Doubts {
  double mass, inertia, thrust, drag, lag, rate_damping, slowest, fastest;
};

T factor(const char* name, const char* of) {
  return T::number(name, "", "1", std::string("believed ") + of + " over that of the plant");
}

const Settings<Doubts>& doubt_settings() {
  static const Settings<Doubts> all = {
      {factor("believed_mass", "mass").above(0), &Doubts::mass},
      {factor("believed_inertia", "inertia").above(0), &Doubts::inertia},
      {factor("believed_thrust", "thrust and torque of a rotor").above(0), &Doubts::thrust},
      {factor("believed_drag", "drag").at_least(0), &Doubts::drag},
      {factor("believed_lag", "time constant of the motors").at_least(0), &Doubts::lag},
      {T::number("rate_damping", "1/s", "0",
                 "of roll and pitch that is believed besides, as Gazebo's engine adds it")
           .at_least(0),
       &Doubts::rate_damping},
      {T::number("slowest", "rad/s", "0", "no rotor is commanded to turn slower").at_least(0),
       &Doubts::slowest},
      {T::number("fastest", "rad/s", "0",
                 "no rotor is commanded to turn faster; 0: what its motor follows")
           .at_least(0),
       &Doubts::fastest},
  };
  return all;
}

void check_spins(const std::vector<double>& spins, std::size_t rotors) {
  const bool are_signs =
      std::all_of(spins.begin(), spins.end(), [](double s) { return s == 1 || s == -1; });
  if (are_signs && spins.size() == rotors) return;
  throw InputError("the spins are no " + std::to_string(rotors) +
                   " signs; give 1 or -1 for each rotor, in the order of the commands");
}

}  // namespace

const std::vector<TagSpec>& Belief::table() {
  static const std::vector<TagSpec> table = table_of(doubt_settings());
  return table;
}

Belief Belief::of(const VehicleDescription& vehicle, std::vector<double> spins,
                  const Values& values) {
  Doubts doubts{};
  configure(doubts, doubt_settings(), values);
  const Vector3d& g_W = vehicle.gravity_W;
  if (!(g_W.z() < 0) || g_W.x() != 0 || g_W.y() != 0) {
    throw InputError("gravity is not along -z of the world, which these laws need");
  }
  const std::vector<std::size_t> driven = vehicle.driven();
  if (spins.empty()) spins = find_spins(vehicle, driven);
  if (spins.empty()) {
    throw InputError("the senses in which " + std::to_string(driven.size()) +
                     " rotors turn are unknown. Give their spins, 1 or -1 each.");
  }
  check_spins(spins, driven.size());

  Belief belief;
  belief.mass = doubts.mass * vehicle.body.mass;
  belief.p_FCcm_F = vehicle.body.p_FCcm;
  belief.inertia_Ccm_F = doubts.inertia * vehicle.body.inertia_Ccm_F;
  belief.gravity = -g_W.z();
  belief.air.linear = doubts.drag * vehicle.air.linear;
  belief.air.quadratic = doubts.drag * vehicle.air.quadratic;
  belief.air.of_components = doubts.drag * vehicle.air.of_components;
  for (int i = 0; i < 2; ++i) {
    belief.air.linear(3 + i, 3 + i) += doubts.rate_damping * belief.inertia_Ccm_F(i, i);
  }
  const std::size_t n = driven.size();
  belief.effectiveness.resize(6, static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const RotorDescription& told = vehicle.rotors[driven[i]];
    const double ratio = told.rate_per_command;
    const double fastest =
        doubts.fastest > 0 ? std::min(doubts.fastest, told.fastest) : told.fastest;
    if (!(doubts.slowest < std::min(fastest, Simulation::max_rate))) {
      throw InputError("'slowest' is not below the fastest speed of rotor '" + told.joint +
                       "', at most 1e6 rad/s. Give a lower one.");
    }
    const double of_command = std::copysign(spins[i], spins[i] * ratio);
    const double lag = std::isnan(told.lag) ? 0 : doubts.lag * told.lag;
    belief.rotors.push_back(
        {told.axis_F, of_command, told.moment * ratio, lag, doubts.slowest, fastest});
    const Wrench& wrench = wrench_of(told, spins[i]);
    belief.effectiveness.col(static_cast<Eigen::Index>(i))
        << doubts.thrust * ratio * ratio * wrench.force_F,
        doubts.thrust * ratio * ratio * wrench.torque_F;
  }
  return belief;
}

Vector3d Belief::air_force_W(const Matrix3d& R_WF, const Vector3d& v_WF_W,
                             const Vector3d& w_WF_F) const {
  const Vector3d v_F = v_WCcm_F(R_WF.transpose() * v_WF_W, w_WF_F), v_W = R_WF * v_F;
  const Vector3d f_F = air.linear.topLeftCorner<3, 3>() * v_F +
                       air.of_components.cwiseProduct(v_W.cwiseAbs()).cwiseProduct(v_W);
  return -(R_WF * f_F) - air.quadratic * v_W.norm() * v_W;
}

Vector3d Belief::air_torque_F(const Vector3d& v_WF_F, const Vector3d& w_WF_F) const {
  return -(air.linear.bottomLeftCorner<3, 3>() * v_WCcm_F(v_WF_F, w_WF_F) +
           air.linear.bottomRightCorner<3, 3>() * w_WF_F);
}

}  // namespace quadcore::control
