#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadcore/control/controller.hpp"
#include "quadcore/control/gains_file.hpp"
#include "schedule.hpp"

/// \file
/// Controllers and references as tags tell of them: those of the plugins, and the parameters of the
/// ROS node.

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A law with its parameters, and when it is called.
struct ControllerSetup {
  static const std::vector<TagSpec>& tags();

  explicit ControllerSetup(const Parameters& parameters);

  /// What the law believes to fly.
  VehicleDescription believed(const VehicleDescription& flown) const;
  Controller controller(const VehicleDescription& flown) const {
    return {gains.law, believed(flown), gains.values, spins};
  }
  Schedule schedule(std::size_t rotors) const { return {gains.rate, gains.delay, rotors}; }
  /// The odometry with its velocity in W.
  Odometry in_world(Odometry now) const {
    if (in_body) now.linear_velocity = now.orientation * now.linear_velocity;
    return now;
  }

  Gains gains;
  std::vector<double> spins;
  std::string belief;  ///< path of the vehicle that is believed to fly; "": what flies
  bool in_body;        ///< whether the odometry's velocity is along the axes of F
};

/// The tags of a shape.
const std::vector<TagSpec>& reference_tags();
/// What they are set to, for a vehicle.
std::unique_ptr<ReferenceShape> reference_of(const Parameters& parameters, const Model& model);

}  // namespace control
}  // namespace quadcore
