#pragma once

#include <algorithm>
#include <optional>

#include "guided_block.hpp"
#include "lane_blocks.hpp"
#include "members.hpp"
#include "quadcore/batch.hpp"
#include "side_by_side.hpp"

namespace quadcore {

using batch::LaneBlocks;
using batch::LaneVehicle;
using batch::Member;

struct BatchSnapshot::Content {
  struct Vehicle {
    std::uint64_t seed;
    std::vector<std::string> warnings;
    std::optional<Snapshot> apart;
  };
  std::shared_ptr<const void> batch;  ///< identity of the batch
  LaneBlocks::Saved lanes;
  std::vector<std::int64_t> steps;
  std::vector<double> commands;
  std::vector<char> is_commanded;
  std::vector<std::string> failures;
  std::vector<int> placements;
  std::vector<double> places;
  std::vector<Vehicle> vehicles;
};

/// Every call starts in the lanes. A vehicle that reaches a bound continues as a Simulation, which
/// handles all cases, and returns to the lanes at the end of the call. A vehicle that is unsuitable
/// for the lanes is always a Simulation. Data that each call uses for every vehicle is stored in
/// separate arrays.
class Batch::Implementation {
 public:
  Implementation(std::vector<BatchVehicle> vehicles, const World& world,
                 const SimulationOptions& options, unsigned threads);

  std::size_t size() const { return members_.size(); }
  std::size_t command_width() const { return common_.command_width(); }
  std::size_t state_width() const { return lanes_->shown_rows(); }
  std::size_t log_width() const { return batch::log_width(common_.rotors()); }
  double dt() const { return common_.dt(); }
  double time(std::size_t i) const { return static_cast<double>(steps_.at(i)) * dt(); }
  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<std::string>& warnings(std::size_t i) const { return members_.at(i).warnings; }

  void step(const double* commands, std::int64_t count);
  void follow(const std::vector<BatchGuide>& guides, const std::string& odometry,
              std::int64_t steps, std::int64_t log_every, std::vector<BatchGuided>& guided,
              const std::function<void()>& poll);
  void follow_together(const CommandAll& command_all, double rate, double delay,
                       const std::string& odometry, std::int64_t steps, std::int64_t log_every,
                       std::vector<BatchGuided>& guided);
  void get_state(double* rows) const;
  void set_state(const double* rows);
  void reset(const bool* mask, const std::uint64_t* seeds);
  BatchSnapshot snapshot() const;
  void restore(const BatchSnapshot& snapshot);

 private:
  const double* command_of(std::size_t i) const { return &commands_[i * command_width()]; }

  /// Call work(block, first vehicle, end of the vehicles, work memory) from several threads.
  /// \param poll  see side_by_side()
  template <class Work, class Poll>
  void for_each_block(const Work& work, const Poll& poll) const {
    const auto fly = [&](std::size_t begin, std::size_t end) {
      LaneNumbers room(lanes_->work_size());
      for (std::size_t block = begin; block < end; ++block) {
        const std::size_t first = block * widest_lanes;
        work(block, first, std::min(size(), first + widest_lanes), room.data());
      }
    };
    side_by_side(threads_, lanes_->blocks(), fly, poll);
  }
  template <class Work>
  void for_each_block(const Work& work) const {
    for_each_block(work, [] {});
  }

  void begin(std::size_t i);

  /// Return the simulation of a vehicle that does not fly in the lanes; it is made if necessary.
  Simulation& simulate_apart(std::size_t i);

  /// Discard the simulation of a vehicle that can fly in the lanes.
  void return_to_lanes(std::size_t i);

  /// Simulate a vehicle that does not fly in the lanes, from its current state.
  /// \param has_commands  whether this call has commands
  void continue_apart(std::size_t i, bool has_commands, std::int64_t steps);

  /// Fly the vehicles of a block that follow in the lanes.
  void follow_in_lanes(std::size_t block, double* work, std::vector<batch::Follower>& followers,
                       std::int64_t steps, std::int64_t log_every, batch::SharedPoll& poll);

  /// Fly a vehicle from its start in its own simulation.
  void follow_apart(std::size_t i, const BatchGuide& guide, const std::string& odometry,
                    std::int64_t steps, std::int64_t log_every, BatchGuided& guided,
                    batch::SharedPoll& poll);

  void note_command(std::size_t i, const double* speeds);

  /// Return the simple sensor of a vehicle in the lanes, or null.
  const batch::LaneSensor* find_sensor(std::size_t i, const std::string& odometry) const;

  batch::Follower make_follower(std::size_t i, const batch::LaneSensor& sensor,
                                const BatchGuide& guide, BatchGuided& guided) const;

  std::uint64_t seed_of(std::size_t i, const batch::LaneSensor& sensor) const;

  /// Throw InputError unless there are as many of something as vehicles.
  void check_count(std::size_t count, const std::string& what) const;
  /// Throw InputError unless every vehicle is at its start and has a row of results.
  void check_start(const std::vector<BatchGuided>& guided) const;
  /// Throw InputError unless every vehicle has a controller that drives its rotors.
  void check_guides(const std::vector<BatchGuide>& guides) const;

  /// Write the measured odometry of all vehicles.
  void measure_all(const std::string& topic, double* rows) const;

  messages::Odometry measure(std::size_t i, const std::string& topic, const double* shown) const;

  void note_rates(const std::vector<double>& states, std::vector<TotalVariation>& rates) const;

  /// Add a row to the log of each vehicle that has not failed.
  void log_all(std::vector<BatchGuided>& guided, const std::vector<double>& states) const;

  /// Store the state of the simulation of a vehicle as that of the vehicle.
  void store_simulation(std::size_t i);

  const std::shared_ptr<const void> identity_ = std::make_shared<int>();
  batch::Common common_;
  unsigned threads_;
  std::vector<Member> members_;
  std::vector<std::int64_t> steps_;
  std::vector<double> commands_;    ///< a row for each vehicle
  std::vector<char> is_commanded_;  ///< whether each vehicle has a command
  std::vector<char> is_apart_;      ///< whether each vehicle has an `apart`
  std::vector<int> placements_;     ///< calls of set_state() since the reset; -1: after a step
  std::vector<double> places_;      ///< rows of the last set_state()
  std::vector<std::string> failures_;
  std::unique_ptr<LaneBlocks> lanes_;
};

}  // namespace quadcore
