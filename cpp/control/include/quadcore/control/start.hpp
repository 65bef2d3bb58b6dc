#pragma once

#include "quadcore/control/reference.hpp"
#include "quadcore/plugin/vehicle_description.hpp"
#include "quadcore/state.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// The state of a vehicle that follows a reference exactly, down to the rates of its joints; joint
/// angles are zero. Throws InputError on a vehicle that laws cannot fly, see Belief::of() and
/// Allocation, and an Error on a reference that has no attitude.
VehicleState start_on(const Reference& wanted, const VehicleDescription& vehicle,
                      const std::vector<double>& spins = {});

/// Speeds to command so that the vehicle hovers level, signed [rad/s], in the order of the command.
/// Throws InputError on a vehicle that laws cannot fly or that its rotors cannot hold.
VectorXd hover_commands(const VehicleDescription& vehicle, const std::vector<double>& spins = {});

}  // namespace control
}  // namespace quadcore
