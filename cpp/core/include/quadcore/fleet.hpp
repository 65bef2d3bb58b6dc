#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/engine.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Complete state of a fleet.
struct FleetSnapshot {
  std::vector<Snapshot> vehicles;  ///< of each vehicle
  std::vector<double> world;       ///< result of SharedWorld::save()
  std::string failure;             ///< reason of a failure, or ""
};

/// Several vehicles in one world. Each is a simulation with its own plugins, topics and seed; only
/// the fleet advances them. A vehicle that touches no other and has no plugin that observes others
/// flies bit for bit as if it were alone.
class Fleet {
 public:
  /// Resets all vehicles. The vehicle that was made last is the newest in the world.
  /// \param vehicles  simulations with the same engine, step and world; they must outlive the fleet
  /// \param names     name of each, for errors
  /// Throws InputError for a simulation of another engine, step or world, or of another fleet.
  Fleet(std::vector<Simulation*> vehicles, std::vector<std::string> names);

  /// Advance all vehicles by a step. Throws FlightError if a flight fails; afterwards only restore
  /// and reset make the fleet usable again.
  void step();

  const std::vector<std::string>& names() const { return names_; }  ///< of the vehicles
  /// Return the present motion of the world's free bodies, in the order of World::free_bodies.
  std::vector<FreeBodyState> free_bodies() const { return shared_->free_bodies(); }
  /// Return warnings about the vehicles together.
  std::vector<std::string> warnings() const { return shared_->warnings(); }

  FleetSnapshot snapshot() const;  ///< of the present state
  /// Throws InputError if the snapshot belongs to another fleet.
  void restore(const FleetSnapshot& snapshot);
  /// Reset to the initial state, each vehicle with its present seed.
  void reset();

 private:
  /// Reset a vehicle, whose engine then moves the free bodies or not.
  static void remake(Simulation& vehicle, bool in_fleet);
  /// Share the world again if a vehicle has a new engine, because it picked up or dropped a body.
  void follow_engines();
  void share();
  /// Act for a vehicle, and record a failure of its flight.
  template <class Act>
  void blame(std::size_t vehicle, const Act& act);
  void throw_failure() const;
  /// Show all vehicles to the plugins that observe others.
  void look_around();

  std::vector<Simulation*> vehicles_;
  std::vector<std::string> names_;
  std::vector<Engine*> engines_;  ///< those that shared_ advances
  std::unique_ptr<SharedWorld> shared_;
  std::vector<double> initial_;  ///< initial state of shared_
  std::vector<SharedWorld::TimedForces> forces_;
  std::vector<OtherVehicle> seen_;     ///< what others see of each vehicle; empty if none looks
  std::vector<OtherVehicles> others_;  ///< pointers into seen_ for each vehicle
  std::string failure_;
};

}  // namespace quadcore
