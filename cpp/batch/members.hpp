#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lane_vehicle.hpp"
#include "quadcore/batch.hpp"

namespace quadcore::batch {

/// A vehicle of a batch, as it is apart from the motion that it shares the lanes for.
struct Member {
  BatchVehicle made_of;
  bool in_lanes = false;
  std::vector<double> start;          ///< in the lanes: as the engine saves it
  std::unique_ptr<Simulation> apart;  ///< in the lanes: as long as it was needed in the last call
  std::vector<std::string> warnings;
  std::size_t warned_at_load = 0;

  /// Adds warnings of the flight; what one in pieces says again is told once.
  void hear(const std::vector<std::string>& said);
};

/// What all vehicles of a batch have in common.
class Common {
 public:
  Common(const World& world, const SimulationOptions& options) : world_(world), options_(options) {}

  std::unique_ptr<Simulation> simulate(const BatchVehicle& vehicle) const;
  /// Takes note of the first vehicle. Throws InputError on one that does not go with it.
  void check(std::size_t i, Simulation& made);
  /// Throws InputError on commands of so many vehicles that are not finite, or are a plugin's.
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
  std::string refused_;  ///< why there can be no commands; "" if there can
};

bool are_built_alike(const BatchVehicle& a, const BatchVehicle& b);

/// To and from a row as Batch::get_state() has it.
void put(const VehicleState& state, double* row);
VehicleState taken(const double* row, Eigen::Index rotors);
/// Throws InputError unless a vehicle can be in this state.
void check(const VehicleState& state, std::size_t vehicle);

/// Members, and of each its kind in the lanes, null for one that is not in them.
struct Crew {
  std::vector<Member> members;
  std::vector<std::shared_ptr<const LaneVehicle>> in_lanes;
};
Crew make_crew(std::vector<BatchVehicle> vehicles, Common& common);

}  // namespace quadcore::batch
