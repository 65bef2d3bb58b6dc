#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "block.hpp"
#include "ode/hinged_model.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::batch {

/// Sensor of odometry that a block measures by itself.
struct LaneSensor {
  std::string topic, plugin;  ///< names
  OdometrySensor sensor;
};

/// Data of one vehicle for the steps of a block.
struct LaneVehicle {
  Laws laws;
  double fastest;                             ///< see Bounds [rad/s]
  bool no_tilt;                               ///< see Bounds
  double reach;                               ///< see Bounds [m]
  std::vector<double> constants;              ///< rows of ConstantRow or HingedRow
  std::vector<int> places;                    ///< index of each rotor in the command
  std::shared_ptr<const HingedModel> hinged;  ///< for gazebo11; null for eigen
};

/// Return the vehicle of a simulation if only force laws for lanes act on it.
std::optional<LaneVehicle> lane_vehicle(const Simulation& simulation);

/// Return the simple sensors of odometry of a simulation, or none if controllers depend on other
/// topics.
std::vector<LaneSensor> list_lane_sensors(const Simulation& simulation);

/// Return whether two vehicles are suitable for the same batch's lanes.
bool fit(const LaneVehicle& one, const LaneVehicle& other);

}  // namespace quadcore::batch
