#pragma once

#include <string>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Read the vehicle that a controller models from a separate URDF, with the gravity of the
/// simulated vehicle. Controllers in the URDF are ignored. Throws InputError for an unsuitable
/// vehicle, or like match_rotors().
VehicleDescription read_modelled_vehicle(const std::string& urdf, const VehicleDescription& flown);

/// Return the modelled vehicle with the command order of the simulated one: joints of the same name
/// follow the same number of the command. Throws InputError if the rotors' names differ.
/// \param who  name of the modelled vehicle, for errors
VehicleDescription match_rotors(const VehicleDescription& flown, VehicleDescription modelled,
                                const std::string& who);

}  // namespace control
}  // namespace quadcore
