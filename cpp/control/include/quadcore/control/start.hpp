#pragma once

#include "quadcore/control/reference.hpp"
#include "quadcore/plugin/vehicle_description.hpp"
#include "quadcore/state.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Return the state of a vehicle that follows a reference exactly, including the rates of its
/// joints; joint angles are zero. Throws InputError for a vehicle that controllers cannot fly, see
/// ModelledVehicle::of() and Allocation, and Error for a reference without a defined attitude.
VehicleState start_on(const Reference& wanted, const VehicleDescription& vehicle,
                      const std::vector<double>& spins = {});

/// Return the signed speeds for level hover [rad/s], in the order of the command. Throws InputError
/// for a vehicle that controllers cannot fly or its rotors cannot hold.
VectorXd hover_commands(const VehicleDescription& vehicle, const std::vector<double>& spins = {});

}  // namespace control
}  // namespace quadcore
