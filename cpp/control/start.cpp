#include "quadcore/control/start.hpp"

#include <cmath>

#include "quadcore/control/allocation.hpp"
#include "quadcore/control/flat_state.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::control {

namespace {

/// Speeds to command on a reference. Throws InputError, saying `too_much`, if the rotors cannot.
VectorXd commands_on(const Reference& wanted, const FlatState& flat, const Belief& truth,
                     const char* too_much) {
  const Allocation allocation(truth);
  const Vector3d tau_air_F =
      truth.air_torque_F(flat.R_WF.transpose() * wanted.velocity, flat.w_WF_F);
  const auto n = static_cast<Eigen::Index>(truth.rotors.size());
  VectorXd squares(n), speeds = VectorXd::Zero(n);
  bool met = true;
  // The torque needs the rotors' momentum, and their speeds need the torque.
  for (int round = 0; round < 4; ++round) {
    Vector3d h_F = Vector3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
      const BelievedRotor& rotor = truth.rotors[static_cast<std::size_t>(i)];
      h_F += rotor.momentum * speeds[i] * rotor.axis_F;
    }
    met = allocation.allocate(
        {flat.thrust, torque_for(truth, flat.dw_WF_F, flat.w_WF_F, h_F, tau_air_F)},
        squares.data());
    for (Eigen::Index i = 0; i < n; ++i) {
      speeds[i] = truth.rotors[static_cast<std::size_t>(i)].spin * std::sqrt(squares[i]);
    }
  }
  if (!met) throw InputError(too_much);
  return speeds;
}

}  // namespace

VehicleState start_on(const Reference& wanted, const VehicleDescription& vehicle,
                      const std::vector<double>& spins) {
  const Belief truth = Belief::of(vehicle, spins, {});
  const FlatState flat = flat_state(wanted, truth, true);
  const VectorXd speeds = commands_on(
      wanted, flat, truth, "the reference begins with more than the rotors can do; take it slower");
  VehicleState state;
  state.position = wanted.position;
  state.orientation = Quaterniond(flat.R_WF).normalized();
  state.linear_velocity = wanted.velocity;
  state.angular_velocity = flat.w_WF_F;
  state.rotor_angle = VectorXd::Zero(static_cast<Eigen::Index>(vehicle.rotors.size()));
  state.rotor_velocity = state.rotor_angle;  // what is not driven stands still
  const std::vector<std::size_t> driven = vehicle.driven();
  for (Eigen::Index i = 0; i < speeds.size(); ++i) {
    const std::size_t joint = driven[static_cast<std::size_t>(i)];
    state.rotor_velocity[static_cast<Eigen::Index>(joint)] =
        speeds[i] * vehicle.rotors[joint].rate_per_command;
  }
  return state;
}

VectorXd hover_commands(const VehicleDescription& vehicle, const std::vector<double>& spins) {
  const Belief truth = Belief::of(vehicle, spins, {});
  const Reference level = {};
  return commands_on(level, flat_state(level, truth, true), truth,
                     "the rotors cannot hold the vehicle: it is too heavy for them, or they are "
                     "out of balance");
}

}  // namespace quadcore::control
