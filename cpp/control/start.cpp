#include "quadcore/control/start.hpp"

#include <cmath>

#include "quadcore/control/allocation.hpp"
#include "quadcore/control/flat_state.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::control {

namespace {

/// Return the speeds to command on a reference. Throws InputError with the message `too_much` if
/// the rotors cannot provide them.
VectorXd commands_on(const Reference& wanted, const FlatState& flat, const ModelledVehicle& truth,
                     const char* too_much) {
  const Allocation allocation(truth);
  const Vector3d tau_air_F =
      truth.air_torque_F(flat.R_WF.transpose() * wanted.velocity, flat.w_WF_F);
  const auto n = static_cast<Eigen::Index>(truth.rotors.size());
  VectorXd squares(n), speeds = VectorXd::Zero(n);
  bool met = true;
  // The torque depends on the rotors' momentum, and their speeds depend on the torque.
  for (int round = 0; round < 4; ++round) {
    Vector3d h_F = Vector3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
      const ModelledRotor& rotor = truth.rotors[static_cast<std::size_t>(i)];
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
  const ModelledVehicle truth = ModelledVehicle::of(vehicle, spins, {});
  const FlatState flat = flat_state(wanted, truth, true);
  const VectorXd speeds = commands_on(
      wanted, flat, truth,
      "the reference starts with more than the rotors can provide. Use a slower reference.");
  VehicleState state;
  state.position = wanted.position;
  state.orientation = Quaterniond(flat.R_WF).normalized();
  state.linear_velocity = wanted.velocity;
  state.angular_velocity = flat.w_WF_F;
  state.rotor_angle = VectorXd::Zero(static_cast<Eigen::Index>(vehicle.rotors.size()));
  state.rotor_velocity = state.rotor_angle;  // joints without a command are at rest
  const std::vector<std::size_t> driven = vehicle.driven();
  for (Eigen::Index i = 0; i < speeds.size(); ++i) {
    const std::size_t joint = driven[static_cast<std::size_t>(i)];
    state.rotor_velocity[static_cast<Eigen::Index>(joint)] =
        speeds[i] * vehicle.rotors[joint].rate_per_command;
  }
  return state;
}

VectorXd hover_commands(const VehicleDescription& vehicle, const std::vector<double>& spins) {
  const ModelledVehicle truth = ModelledVehicle::of(vehicle, spins, {});
  const Reference level = {};
  return commands_on(level, flat_state(level, truth, true), truth,
                     "the rotors cannot hold the vehicle in hover: it is too heavy, or its centre "
                     "of mass is too far off the rotors' centre. Change the mass or the rotors.");
}

}  // namespace quadcore::control
