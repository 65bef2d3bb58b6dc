#pragma once

#include <memory>
#include <optional>

#include "block.hpp"
#include "ode/hinged_model.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::batch {

/// What steps of a block take of one vehicle.
struct LaneVehicle {
  Laws laws;
  double fastest;                             ///< as Bounds, rad/s
  bool no_tilt;                               ///< as Bounds
  double reach;                               ///< as Bounds [m]
  std::vector<double> constants;              ///< rows as ConstantRow has them, or HingedRow
  std::vector<int> places;                    ///< of each rotor, of its number in the command
  std::shared_ptr<const HingedModel> hinged;  ///< for gazebo11; null for eigen
};

/// The vehicle of a simulation, if laws that fly in lanes are all that acts on it.
std::optional<LaneVehicle> lane_vehicle(const Simulation& simulation);

/// Whether two may fly in one batch's lanes.
bool fit(const LaneVehicle& one, const LaneVehicle& other);

}  // namespace quadcore::batch
