#pragma once

#include <string>

#include "quadcore/export.hpp"
#include "quadcore/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A vehicle from a URDF of its own, for a controller that is to believe in it, in the gravity of
/// the one that flies. Controllers in the URDF are left out. Throws InputError if it cannot be
/// flown, or has another number of rotors.
VehicleDescription second_vehicle(const std::string& urdf, const VehicleDescription& flown);

}  // namespace control
}  // namespace quadcore
