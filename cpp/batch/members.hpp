#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lane_vehicle.hpp"
#include "quadcore/batch.hpp"

namespace quadcore::batch {

/// A vehicle of a batch, without its motion in the lanes.
struct Member {
  BatchVehicle vehicle;
  bool in_lanes = false;
  std::vector<double> start;  ///< in the lanes: initial state as saved by the engine
  std::shared_ptr<const std::vector<LaneSensor>>
      sensors;  ///< in the lanes: see list_lane_sensors()
  std::unique_ptr<Simulation>
      apart;  ///< in the lanes: simulation of the last call, if it was needed
  std::vector<std::string> warnings;
  std::size_t warned_at_load = 0;

  /// Add warnings of the flight, without repetitions.
  void add_warnings(const std::vector<std::string>& added);
};

/// Common properties of all vehicles of a batch.
class Common {
 public:
  Common(const World& world, const SimulationOptions& options) : world_(world), options_(options) {}

  std::unique_ptr<Simulation> simulate(const BatchVehicle& vehicle) const;
  /// Store the properties of the first vehicle. Throws InputError for another vehicle that does not
  /// match.
  void check(std::size_t i, Simulation& made);
  /// Throw InputError for commands of so many vehicles that are not finite, or that a plugin gives.
  void check(const double* commands, std::size_t vehicles) const;

  const World& world() const { return world_; }
  double dt() const { return dt_; }
  std::size_t command_width() const { return command_width_; }
  std::size_t rotors() const { return rotors_; }

 private:
  World world_;
  SimulationOptions options_;
  double dt_ = 0;
  std::size_t command_width_ = 0, rotors_ = 0;
  std::string refused_;  ///< reason why commands are not possible, or ""
};

bool are_built_alike(const BatchVehicle& a, const BatchVehicle& b);

/// Convert to and from a row of Batch::get_state().
void write_state(const VehicleState& state, double* row);
VehicleState read_state(const double* row, Eigen::Index rotors);
/// Throw InputError for a state that is invalid for a vehicle.
void check(const VehicleState& state, std::size_t vehicle);

/// Members, and the lane vehicle of each, null for one that is not in the lanes.
struct Members {
  std::vector<Member> members;
  std::vector<std::shared_ptr<const LaneVehicle>> in_lanes;
};
Members make_members(std::vector<BatchVehicle> vehicles, Common& common);

}  // namespace quadcore::batch
