#pragma once

#include <string>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/vehicle_description.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A vehicle from a URDF of its own, for a controller that is to believe in it, in the gravity of
/// the one that flies. Controllers in the URDF are left out. Throws InputError if it cannot be
/// flown, or as driven_as() does.
VehicleDescription second_vehicle(const std::string& urdf, const VehicleDescription& flown);

/// A vehicle that is believed to fly, driven as the one that flies: the joint of the same name
/// follows the same number of the command. Throws InputError if its rotors have other names.
/// \param who  the one that is believed, for errors
VehicleDescription driven_as(const VehicleDescription& flown, VehicleDescription believed,
                             const std::string& who);

}  // namespace control
}  // namespace quadcore
