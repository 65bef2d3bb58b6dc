#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadcore/control/controller.hpp"
#include "quadcore/control/gains_file.hpp"
#include "quadcore/control/schedule.hpp"

/// \file
/// Controllers and references defined by tags: those of the plugins, and the parameters of the ROS
/// node.

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A controller with its parameters and its timing.
struct ControllerSetup {
  static const std::vector<TagSpec>& tags();

  explicit ControllerSetup(const Parameters& parameters);

  /// Return the vehicle that the controller models.
  VehicleDescription describe_model(const VehicleDescription& flown) const;
  Controller controller(const VehicleDescription& flown) const {
    return {gains.law, describe_model(flown), gains.values, spins};
  }
  Schedule schedule(std::size_t rotors) const { return {gains.rate, gains.delay, rotors}; }
  /// Return the odometry with its velocity in W.
  Odometry in_world(Odometry now) const {
    if (in_body) now.linear_velocity = now.orientation * now.linear_velocity;
    return now;
  }

  Gains gains;
  std::vector<double> spins;
  std::string model_path;  ///< path of the modelled vehicle; "": the simulated vehicle
  bool in_body;            ///< whether the odometry's velocity is in axes of F
};

/// Return the tags of all references.
const std::vector<TagSpec>& reference_tags();
/// Create the reference that the tags define, for a vehicle.
std::unique_ptr<ReferenceShape> reference_of(const Parameters& parameters, const Model& model);

}  // namespace control
}  // namespace quadcore
