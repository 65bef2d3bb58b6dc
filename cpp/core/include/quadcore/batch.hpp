#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore QUADCORE_EXPORT {

/// One vehicle of a batch.
struct BatchVehicle {
  std::shared_ptr<const Model> model;                  ///< model of the vehicle
  std::map<std::string, std::string> parameters = {};  ///< like SimulationOptions::parameters
  Pose spawn = {};                                     ///< initial pose of the frame in the world
  std::uint64_t seed = 0;                              ///< seed of all random numbers
};

namespace control {
class Controller;
class ReferenceShape;
}  // namespace control

/// Controller of a vehicle of a batch, and what it follows. Both may serve several vehicles and
/// must exist while the vehicles follow.
struct BatchGuide {
  const control::Controller* controller;     ///< not null
  const control::ReferenceShape* reference;  ///< not null
  double rate;                               ///< calls per simulated second
  double delay;  ///< from a call to the step at which its command acts [s]
};

/// A flight of a vehicle of a batch under a controller.
struct BatchGuided {
  /// Where to write the rows of its log, in the columns of log_columns(): room for the first and
  /// one after each `log_every` steps. Null: no log.
  double* log = nullptr;
  std::int64_t rows = 0;       ///< number of written rows
  std::int64_t calls = 0;      ///< number of calls of the controller
  std::int64_t saturated = 0;  ///< those with a demand that the rotors could not exert
  /// Total variation of the magnitudes of the joint rates over all steps [rad/s].
  std::vector<double> rate_variation = {};
  /// Total variation of the magnitudes of the commands [rad/s].
  std::vector<double> command_variation = {};
  /// Durations of every sixteenth call [s].
  std::vector<double> seconds = {};
};

/// Complete state of a batch.
struct BatchSnapshot {
  struct Content;
  std::shared_ptr<const Content> content;  ///< internal, read only by restore()
};

/// Several vehicles, each in its own world, that are stepped together. The results are
/// bit-identical to separate Simulations, for any batch size and number of threads. In the engine
/// eigen, several vehicles share each instruction as long as only ForceLaws act on them.
class Batch {
 public:
  /// \param options  common options: engine and dt; the others belong to each vehicle
  /// \param threads  number of threads; 0: one for each processor
  /// Throws InputError like Simulation, and for vehicles with different numbers of rotors.
  Batch(std::vector<BatchVehicle> vehicles, const World& world, const SimulationOptions& options,
        unsigned threads = 0);
  ~Batch();
  /// A moved-from batch can only be destroyed.
  Batch(Batch&&) noexcept;

  std::size_t size() const;           ///< number of vehicles
  std::size_t command_width() const;  ///< number of values in a vehicle's command
  double dt() const;                  ///< time step [s]

  /// Advance all vehicles that have not failed by so many steps.
  /// \param commands  rotor speeds [rad/s], a row of command_width() for each vehicle; null: the
  ///                  previous commands, or those of plugins
  /// Throws InputError without changes for a number that is not finite, or for commands if a plugin
  /// gives them.
  void step(const double* commands, std::int64_t count = 1);

  /// Advance all vehicles that have not failed under controllers.
  /// \param guides     one for each vehicle
  /// \param odometry   topic of the measured state
  /// \param log_every  number of steps between rows of the logs
  /// \param guided     one for each vehicle
  /// \param poll       called at times by the calling thread; may throw to end the call
  /// Throws InputError without changes for a vehicle that is not at time 0 or has moved since its
  /// reset, for a controller of another number of rotors, and for a wrong count of `guides` or
  /// `guided`. Throws what a controller throws; the vehicles are then at different times.
  void follow(const std::vector<BatchGuide>& guides, const std::string& odometry,
              std::int64_t steps, std::int64_t log_every, std::vector<BatchGuided>& guided,
              const std::function<void()>& poll);

  /// Number of values in a row of measured odometry: position, orientation (x, y, z, w), linear and
  /// angular velocity.
  static constexpr std::size_t odometry_width = 13;
  /// Commands all vehicles at once.
  /// \param time      simulation time [s]
  /// \param odometry  a row for each vehicle
  /// \param speeds    where to write a row of command_width() for each vehicle [rad/s]
  using CommandAll = std::function<void(double time, const double* odometry, double* speeds)>;
  /// Advance all vehicles that have not failed under one controller, otherwise like follow().
  /// \param rate, delay  see BatchGuide
  /// Throws InputError for an odometry topic that some vehicle cannot measure in the lanes, and for
  /// speeds that are not finite.
  void follow_together(const CommandAll& command_all, double rate, double delay,
                       const std::string& odometry, std::int64_t steps, std::int64_t log_every,
                       std::vector<BatchGuided>& guided);

  /// Return the number of values in a row of get_state().
  std::size_t state_width() const;
  /// Return the number of values in a row of a log: the time, and a row of get_state() without the
  /// joint angles at its end.
  std::size_t log_width() const;
  /// Write a row for each vehicle: p_WF [m], the quaternion of F in W (x, y, z, w), v_WF_W [m/s],
  /// w_WF_F [rad/s], all joint rates [rad/s], and all joint angles [rad].
  void get_state(double* rows) const;
  /// Set the states of all vehicles at time 0, like Simulation::set_state(). Failed flights
  /// continue, and commands remain. Throws InputError without changes for a number that is not
  /// finite or an invalid quaternion.
  void set_state(const double* rows);
  double time(std::size_t vehicle) const;  ///< s
  /// Return the reason why each flight failed; "" while it continues. A failed vehicle stays where
  /// it is.
  const std::vector<std::string>& failures() const;
  /// Return the warnings of each flight.
  const std::vector<std::string>& warnings(std::size_t vehicle) const;

  /// Reset vehicles to their start.
  /// \param mask   whether to reset each vehicle
  /// \param seeds  seed of each vehicle; null: the previous seeds
  void reset(const bool* mask, const std::uint64_t* seeds = nullptr);

  /// Return the complete state of all vehicles.
  BatchSnapshot snapshot() const;
  /// Restore a snapshot. Throws InputError without changes for a snapshot of another batch.
  void restore(const BatchSnapshot& snapshot);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadcore
