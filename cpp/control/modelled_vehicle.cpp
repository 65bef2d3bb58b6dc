#include "quadcore/control/modelled_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "numbers.hpp"
#include "quadcore/control/rotors.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

/// Model errors: factors on the true parameters, and speed limits.
struct ModelErrors {
  double mass, inertia, thrust, drag, lag, rate_damping, slowest, fastest;
};

T factor(const char* name, const char* of) {
  return T::number(name, "", "1", std::string("modelled ") + of + " divided by the true one");
}

const Settings<ModelErrors>& error_settings() {
  static const Settings<ModelErrors> all = {
      {factor("believed_mass", "mass").above(0), &ModelErrors::mass},
      {factor("believed_inertia", "inertia").above(0), &ModelErrors::inertia},
      {factor("believed_thrust", "thrust and torque of a rotor").above(0), &ModelErrors::thrust},
      {factor("believed_drag", "drag").at_least(0), &ModelErrors::drag},
      {factor("believed_lag", "time constant of the motors").at_least(0), &ModelErrors::lag},
      {T::number("rate_damping", "1/s", "0",
                 "additional modelled damping of roll and pitch, as Gazebo's engine adds it")
           .at_least(0),
       &ModelErrors::rate_damping},
      {T::number("slowest", "rad/s", "0", "minimum commanded rotor speed").at_least(0),
       &ModelErrors::slowest},
      {T::number("fastest", "rad/s", "0", "maximum commanded rotor speed; 0: the motor's limit")
           .at_least(0),
       &ModelErrors::fastest},
  };
  return all;
}

void check_spins(const std::vector<double>& spins, std::size_t rotors) {
  const bool are_signs =
      std::all_of(spins.begin(), spins.end(), [](double s) { return s == 1 || s == -1; });
  if (are_signs && spins.size() == rotors) return;
  throw InputError("the spins are not " + std::to_string(rotors) +
                   " signs. Give 1 or -1 for each rotor, in the order of the command.");
}

}  // namespace

const std::vector<TagSpec>& ModelledVehicle::table() {
  static const std::vector<TagSpec> table = table_of(error_settings());
  return table;
}

ModelledVehicle ModelledVehicle::of(const VehicleDescription& vehicle, std::vector<double> spins,
                                    const Values& values) {
  ModelErrors errors{};
  configure(errors, error_settings(), values);
  const Vector3d& g_W = vehicle.gravity_W;
  if (!(g_W.z() < 0) || g_W.x() != 0 || g_W.y() != 0) {
    throw InputError(
        "gravity does not point along -z of the world, which the controllers require. Change the "
        "world's gravity.");
  }
  const std::vector<std::size_t> driven = vehicle.driven();
  if (spins.empty()) spins = find_spins(vehicle, driven);
  if (spins.empty()) {
    throw InputError("the directions of rotation of " + std::to_string(driven.size()) +
                     " rotors are unknown. Give their spins, 1 or -1 each.");
  }
  check_spins(spins, driven.size());

  ModelledVehicle model;
  model.mass = errors.mass * vehicle.body.mass;
  model.p_FCcm_F = vehicle.body.p_FCcm;
  model.inertia_Ccm_F = errors.inertia * vehicle.body.inertia_Ccm_F;
  model.gravity = -g_W.z();
  model.air.linear = errors.drag * vehicle.air.linear;
  model.air.quadratic = errors.drag * vehicle.air.quadratic;
  model.air.of_components = errors.drag * vehicle.air.of_components;
  for (int i = 0; i < 2; ++i) {
    model.air.linear(3 + i, 3 + i) += errors.rate_damping * model.inertia_Ccm_F(i, i);
  }
  const std::size_t n = driven.size();
  model.effectiveness.resize(6, static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const RotorDescription& rotor = vehicle.rotors[driven[i]];
    const double ratio = rotor.rate_per_command;
    const double fastest =
        errors.fastest > 0 ? std::min(errors.fastest, rotor.fastest) : rotor.fastest;
    if (!(errors.slowest < std::min(fastest, Simulation::max_rate))) {
      throw InputError("'slowest' is not below the maximum speed of rotor '" + rotor.joint +
                       "', which is at most 1e6 rad/s. Give a lower value.");
    }
    const double of_command = std::copysign(spins[i], spins[i] * ratio);
    const double lag = std::isnan(rotor.lag) ? 0 : errors.lag * rotor.lag;
    model.rotors.push_back(
        {rotor.axis_F, of_command, rotor.moment * ratio, lag, errors.slowest, fastest});
    const Wrench& wrench = wrench_of(rotor, spins[i]);
    model.effectiveness.col(static_cast<Eigen::Index>(i))
        << errors.thrust * ratio * ratio * wrench.force_F,
        errors.thrust * ratio * ratio * wrench.torque_F;
  }
  return model;
}

Vector3d ModelledVehicle::air_force_W(const Matrix3d& R_WF, const Vector3d& v_WF_W,
                                      const Vector3d& w_WF_F) const {
  const VehicleNumbers<double> vehicle = numbers_of(*this);
  const Matrix3<double> R = numbers_of(R_WF);
  const Vec3<double> v_F = laws::inversely(R, numbers_of(v_WF_W));
  return vector_of(R * air_force_F(vehicle.air, R, v_WCcm_F(vehicle, v_F, numbers_of(w_WF_F))));
}

Vector3d ModelledVehicle::air_torque_F(const Vector3d& v_WF_F, const Vector3d& w_WF_F) const {
  return vector_of(
      control::air_torque_F(numbers_of(*this), numbers_of(v_WF_F), numbers_of(w_WF_F)));
}

}  // namespace quadcore::control
