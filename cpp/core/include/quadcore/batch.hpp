#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore QUADCORE_EXPORT {

/// One vehicle of a batch.
struct BatchVehicle {
  std::shared_ptr<const Model> model;                  ///< what flies
  std::map<std::string, std::string> parameters = {};  ///< as in SimulationOptions
  Pose spawn = {};                                     ///< of the frame in the world, at the start
  std::uint64_t seed = 0;                              ///< of all random numbers
};

/// Everything that the future of a batch depends on.
struct BatchSnapshot {
  struct Content;
  std::shared_ptr<const Content> content;  ///< for restore() alone to read
};

/// Many vehicles, each in a world of its own, stepped together. Each moves, to the last bit, as a
/// Simulation of it does, whatever others there are and however many threads. In the engine eigen
/// several share each instruction as long as nothing but laws acts on them (see ForceLaws).
class Batch {
 public:
  /// \param options  what all have in common: engine and dt; the rest is each vehicle's own
  /// \param threads  that step; 0: one for each processor
  /// Throws InputError on what a Simulation of one would refuse, or rotors of different numbers.
  Batch(std::vector<BatchVehicle> vehicles, const World& world, const SimulationOptions& options,
        unsigned threads = 0);
  ~Batch();
  /// What was moved from can only be destroyed.
  Batch(Batch&&) noexcept;

  std::size_t size() const;           ///< vehicles
  std::size_t command_width() const;  ///< numbers of a vehicle's command
  double dt() const;                  ///< length of a step, s

  /// Advances all that have not failed by so many steps.
  /// \param commands  rotor speeds [rad/s], a row of command_width() for each vehicle; null: as
  ///                  before, or as plugins command
  /// Throws InputError, nothing changed, on a number that is not finite, or on commands if a plugin
  /// gives them.
  void step(const double* commands, std::int64_t count = 1);

  /// Numbers of a row of get_state().
  std::size_t state_width() const;
  /// Writes a row for each vehicle: p_WF [m], the quaternion of F in W (x, y, z, w), v_WF_W [m/s],
  /// w_WF_F [rad/s], then all joint rates [rad/s], then all joint angles [rad].
  void get_state(double* rows) const;
  /// Takes all vehicles to such states at time 0, as Simulation::set_state() does one; a flight
  /// that failed goes on. Commands stay. Throws InputError, nothing changed, on a number that is
  /// not finite or a quaternion that is none.
  void set_state(const double* rows);
  double time(std::size_t vehicle) const;  ///< s
  /// Why each flight ended; "" while it goes on. One that ended stays where it did.
  const std::vector<std::string>& failures() const;
  /// What was said of each flight.
  const std::vector<std::string>& warnings(std::size_t vehicle) const;

  /// Takes vehicles back to their start.
  /// \param mask   of each, whether it is one of them
  /// \param seeds  of each, or null: as it had
  void reset(const bool* mask, const std::uint64_t* seeds = nullptr);

  /// Everything that the future of all depends on.
  BatchSnapshot snapshot() const;
  /// Throws InputError, nothing changed, on the snapshot of another batch.
  void restore(const BatchSnapshot& snapshot);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadcore
