#include "quadcore/batch.hpp"

#include <algorithm>
#include <thread>

#include "guided_block.hpp"
#include "lane_blocks.hpp"
#include "members.hpp"
#include "quadcore/control/guided_controller.hpp"
#include "quadcore/control/schedule.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/random.hpp"
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
  std::shared_ptr<const void> of;  ///< identity of the batch
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
                 const SimulationOptions& options, unsigned threads)
      : common_(world, options), threads_(threads) {
    if (world.start_time != 0) {
      throw InputError(
          "a batch cannot start at the time of a saved world. Remove <state> from the world, or "
          "simulate each vehicle alone.");
    }
    batch::Crew crew = batch::make_crew(std::move(vehicles), common_);
    members_ = std::move(crew.members);
    steps_.resize(size());
    is_apart_.resize(size());
    is_commanded_.resize(size());
    commands_.resize(size() * command_width());
    failures_.resize(size());
    placements_.resize(size());
    lanes_ = std::make_unique<LaneBlocks>(crew.in_lanes, common_.rotors(), world);
    for (std::size_t i = 0; i < size(); ++i) begin(i);
  }

  std::size_t size() const { return members_.size(); }
  std::size_t command_width() const { return common_.command_width(); }
  std::size_t state_width() const { return lanes_->shown_rows(); }
  double dt() const { return common_.dt(); }
  double time(std::size_t i) const { return static_cast<double>(steps_.at(i)) * dt(); }
  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<std::string>& warnings(std::size_t i) const { return members_.at(i).warnings; }

  void step(const double* commands, std::int64_t count) {
    if (count < 0)
      throw InputError("the step count is " + std::to_string(count) +
                       ". Give a whole number >= 0.");
    if (commands) {
      common_.check(commands, size());
      std::copy_n(commands, commands_.size(), commands_.begin());
      std::fill(is_commanded_.begin(), is_commanded_.end(), true);
    }
    for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
      std::int64_t flown[widest_lanes];
      for (std::size_t i = first; commands && i < end; ++i) lanes_->command(i, command_of(i));
      lanes_->step(block, count, dt(), work, flown);
      for (std::size_t i = first; i < end; ++i) {
        const bool hears =
            commands && is_apart_[i] && !members_[i].in_lanes;  // even without a following step
        if (!failures_[i].empty()) {
          if (hears) members_[i].apart->command(command_of(i), command_width());
          continue;
        }
        steps_[i] += flown[i - first];
        if (flown[i - first] < count || hears) {
          go_on_apart(i, commands, count - flown[i - first]);
        } else if (count > 0 && is_apart_[i]) {
          come_back(i);
        }
      }
    });
  }

  void follow(const std::vector<BatchGuide>& guides, const std::string& odometry,
              std::int64_t steps, std::int64_t log_every, std::vector<BatchGuided>& guided,
              const std::function<void()>& poll) {
    check_start();
    const std::thread::id caller = std::this_thread::get_id();
    for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
      if (std::this_thread::get_id() == caller) poll();
      std::vector<batch::Follower> followers;
      std::vector<std::size_t> apart;
      for (std::size_t i = first; i < end; ++i) {
        if (!failures_[i].empty()) continue;
        come_back(i);
        const batch::LaneSensor* sensor = find_sensor(i, odometry);
        if (sensor && lanes_->flies(i)) {
          followers.push_back(make_follower(i, *sensor, guides[i], guided[i]));
        } else {
          apart.push_back(i);
          lanes_->let_fly(i, false);
        }
      }
      if (!followers.empty()) {
        batch::GuidedBlock(*lanes_, block, dt(), work).advance(followers, steps, log_every);
      }
      for (const batch::Follower& follower : followers) {
        if (follower.has_left) {
          apart.push_back(follower.vehicle);
          continue;
        }
        steps_[follower.vehicle] += steps;
        if (!follower.speeds.empty()) note_command(follower.vehicle, follower.speeds.data());
      }
      for (const std::size_t i : apart) {
        follow_apart(i, guides[i], odometry, steps, log_every, guided[i]);
      }
    });
  }

  void follow_together(const CommandAll& command_all, double rate, double delay,
                       const std::string& odometry, std::int64_t steps, std::int64_t log_every,
                       std::vector<BatchGuided>& guided) {
    check_start();
    for (std::size_t i = 0; i < size(); ++i) {
      come_back(i);
      if (!members_[i].in_lanes || find_sensor(i, odometry)) continue;
      throw InputError("vehicle " + std::to_string(i) + " measures topic '" + odometry +
                       "' in a way that batches do not model. Simulate it alone.");
    }
    const control::Schedule schedule(rate, delay, size() * command_width());
    std::vector<double> pending(schedule.state_size()), states(size() * state_width()),
        measured(size() * Batch::odometry_width);
    std::vector<control::TotalVariation> rates(size(), control::TotalVariation(common_.rotors())),
        commands(size(), control::TotalVariation(command_width()));
    get_state(states.data());
    log_all(guided, states);
    note_rates(states, rates);
    for (std::int64_t done = 0; done < steps;) {
      const auto now = static_cast<double>(done);
      const double* const speeds =
          schedule.update(now, dt(), pending.data(), [&](double, double* asked) {
            measure_all(odometry, measured.data());
            command_all(now * dt(), measured.data(), asked);
          });
      for (std::size_t i = 0; speeds && i < size(); ++i) {
        if (failures_[i].empty()) commands[i].add(speeds + i * command_width());
      }
      step(speeds, 1);
      ++done;
      get_state(states.data());
      if (done % log_every == 0) log_all(guided, states);
      note_rates(states, rates);
    }
    for (std::size_t i = 0; i < size(); ++i) {
      guided[i].rate_variation = rates[i].sums();
      guided[i].command_variation = commands[i].sums();
    }
  }

  void get_state(double* rows) const {
    for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
      lanes_->show(block, end - first, work, rows + first * state_width());
      for (std::size_t i = first; i < end; ++i) {
        if (!is_apart_[i] || (members_[i].in_lanes && failures_[i].empty())) continue;
        batch::put(members_[i].apart->state(), rows + i * state_width());
      }
    });
  }

  void set_state(const double* rows) {
    const auto rotors = static_cast<Eigen::Index>(common_.rotors());
    std::vector<VehicleState> states;
    for (std::size_t i = 0; i < size(); ++i) {
      states.push_back(batch::taken(rows + i * state_width(), rotors));
      batch::check(states.back(), i);
    }
    places_.assign(rows, rows + size() * state_width());
    std::unique_ptr<Simulation> alike;  // of the previous vehicle
    for (std::size_t i = 0; i < size(); ++i) {
      Member& member = members_[i];
      failures_[i].clear();
      placements_[i] = steps_[i] == 0 && placements_[i] >= 0 ? placements_[i] + 1 : -1;
      steps_[i] = 0;
      if (!member.in_lanes) {
        go_apart(i).set_state(states[i]);
        continue;
      }
      come_back(i);
      if (!alike || !batch::are_built_alike(member.made_of, members_[i - 1].made_of)) {
        alike = common_.simulate(member.made_of);
      }
      alike->set_state(states[i]);
      lanes_->set_engine_state(i, alike->snapshot().engine);
      lanes_->let_fly(i, true);
    }
  }

  void reset(const bool* mask, const std::uint64_t* seeds) {
    for (std::size_t i = 0; i < size(); ++i) {
      if (!mask[i]) continue;
      if (seeds) members_[i].made_of.seed = seeds[i];
      begin(i);
    }
  }

  BatchSnapshot snapshot() const {
    auto taken = std::make_shared<BatchSnapshot::Content>();
    taken->of = identity_;
    taken->lanes = lanes_->save();
    taken->steps = steps_;
    taken->commands = commands_;
    taken->is_commanded = is_commanded_;
    taken->failures = failures_;
    taken->placements = placements_;
    taken->places = places_;
    for (const Member& member : members_) {
      taken->vehicles.push_back({member.made_of.seed, member.warnings, {}});
      if (member.apart) taken->vehicles.back().apart = member.apart->snapshot();
    }
    return {taken};
  }

  void restore(const BatchSnapshot& snapshot) {
    const BatchSnapshot::Content& taken = *snapshot.content;
    if (taken.of != identity_)
      throw InputError(
          "snapshot: it was taken from another batch. Restore a snapshot of this batch.");
    lanes_->restore(taken.lanes);
    steps_ = taken.steps;
    commands_ = taken.commands;
    is_commanded_ = taken.is_commanded;
    failures_ = taken.failures;
    placements_ = taken.placements;
    places_ = taken.places;
    for (std::size_t i = 0; i < size(); ++i) {
      members_[i].made_of.seed = taken.vehicles[i].seed;
      members_[i].warnings = taken.vehicles[i].warnings;
      if (taken.vehicles[i].apart) {
        go_apart(i).restore(*taken.vehicles[i].apart);
      } else {
        come_back(i);
      }
    }
  }

 private:
  const double* command_of(std::size_t i) const { return &commands_[i * command_width()]; }

  /// Call work(block, first vehicle, end of the vehicles, work memory) from several threads.
  template <class Work>
  void for_each_block(const Work& work) const {
    side_by_side(threads_, lanes_->blocks(), [&](std::size_t begin, std::size_t end) {
      LaneNumbers room(lanes_->work_size());
      for (std::size_t block = begin; block < end; ++block) {
        const std::size_t first = block * widest_lanes;
        work(block, first, std::min(size(), first + widest_lanes), room.data());
      }
    });
  }

  void begin(std::size_t i) {
    Member& member = members_[i];
    steps_[i] = placements_[i] = 0;
    is_commanded_[i] = false;
    failures_[i].clear();
    member.warnings.resize(member.warned_at_load);
    if (member.in_lanes) {
      come_back(i);
      lanes_->begin(i, member.start);
    } else {
      go_apart(i).reset(member.made_of.seed);
    }
  }

  Simulation& go_apart(std::size_t i) {
    if (!members_[i].apart) members_[i].apart = common_.simulate(members_[i].made_of);
    is_apart_[i] = true;
    return *members_[i].apart;
  }

  void come_back(std::size_t i) {
    if (!members_[i].in_lanes) return;
    members_[i].apart.reset();
    is_apart_[i] = false;
  }

  /// \param told  whether this call has commands
  void go_on_apart(std::size_t i, bool told, std::int64_t steps) {
    Member& member = members_[i];
    Simulation& simulation = go_apart(i);
    if (member.in_lanes) {
      Snapshot now = simulation.snapshot();
      lanes_->get_engine_state(i, now.engine);
      now.steps = steps_[i];
      simulation.restore(now);
    }
    try {
      // For a vehicle that is never in the lanes, the simulation stores the command and its time.
      const bool forgot = member.in_lanes && is_commanded_[i];
      if (told || forgot) simulation.command(command_of(i), command_width());
      simulation.step(steps);
    } catch (const FlightError& error) {
      failures_[i] = error.what();
    }
    settle(i);
  }

  /// Fly a vehicle from its start in its own simulation.
  void follow_apart(std::size_t i, const BatchGuide& guide, const std::string& odometry,
                    std::int64_t steps, std::int64_t log_every, BatchGuided& guided) {
    Simulation& simulation = go_apart(i);
    if (members_[i].in_lanes) {
      simulation.reset(members_[i].made_of.seed);
      const auto rotors = static_cast<Eigen::Index>(common_.rotors());
      for (int k = 0; k < placements_[i]; ++k) {
        simulation.set_state(batch::taken(&places_[i * state_width()], rotors));
      }
      if (is_commanded_[i]) simulation.command(command_of(i), command_width());
    }
    guided = BatchGuided{guided.log};
    try {
      batch::follow_apart(simulation, guide, odometry, steps, log_every, guided);
    } catch (const FlightError& error) {
      failures_[i] = error.what();
    }
    const Topics& topics = simulation.topics();
    const Topic& commands = topics[topics.at(Simulation::command_topic)];
    note_command(i, commands.values.data());
    settle(i);
  }

  void note_command(std::size_t i, const double* speeds) {
    is_commanded_[i] = true;
    std::copy_n(speeds, command_width(), &commands_[i * command_width()]);
  }

  /// Return the simple sensor of a vehicle in the lanes, or null.
  const batch::LaneSensor* find_sensor(std::size_t i, const std::string& odometry) const {
    if (!members_[i].in_lanes) return nullptr;
    for (const batch::LaneSensor& sensor : *members_[i].sensors) {
      if (sensor.topic == odometry) return &sensor;
    }
    return nullptr;
  }

  batch::Follower make_follower(std::size_t i, const batch::LaneSensor& sensor,
                                const BatchGuide& guide, BatchGuided& guided) const {
    const OdometryErrors& errors = sensor.sensor.errors;
    return {i,
            &guide,
            &guided,
            &errors,
            seed_of(i, sensor),
            placements_[i] * errors.draws(),
            control::TotalVariation(common_.rotors()),
            control::TotalVariation(command_width())};
  }

  std::uint64_t seed_of(std::size_t i, const batch::LaneSensor& sensor) const {
    const std::uint64_t seed = stream_seed(members_[i].made_of.seed, sensor.plugin);
    return sensor.sensor.seed.value_or(seed);
  }

  void check_start() const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (steps_[i] == 0 && placements_[i] >= 0) continue;
      throw InputError("vehicle " + std::to_string(i) +
                       " is not at its start, where controllers take over. Call reset first.");
    }
  }

  /// Write the measured odometry of all vehicles.
  void measure_all(const std::string& topic, double* rows) const {
    for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
      lanes_->show(block, work);
      for (std::size_t i = first; i < end; ++i) {
        const messages::Odometry now = measure(i, topic, work + i % widest_lanes);
        double* row = std::copy_n(now.position.data(), 3, rows + i * Batch::odometry_width);
        row = std::copy_n(now.orientation.coeffs().data(), 4, row);
        row = std::copy_n(now.linear_velocity.data(), 3, row);
        std::copy_n(now.angular_velocity.data(), 3, row);
      }
    });
  }

  messages::Odometry measure(std::size_t i, const std::string& topic, const double* shown) const {
    const batch::LaneSensor* sensor = find_sensor(i, topic);
    if (!sensor) {
      const Topics& topics = members_[i].apart->topics();
      return topics.read<messages::Odometry>(
          control::GuidedController::find_odometry(topics, topic));
    }
    const OdometryErrors& errors = sensor->sensor.errors;
    const auto before = static_cast<double>(placements_[i] + steps_[i]);
    return batch::measure(shown, errors, seed_of(i, *sensor), before * errors.draws());
  }

  void note_rates(const std::vector<double>& states,
                  std::vector<control::TotalVariation>& rates) const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (failures_[i].empty()) rates[i].add(&states[i * state_width() + 13]);
    }
  }

  /// Add a row to the log of each vehicle that has not failed.
  void log_all(std::vector<BatchGuided>& guided, const std::vector<double>& states) const {
    const std::size_t columns = batch::StateRow::joints + common_.rotors();
    for (std::size_t i = 0; i < size(); ++i) {
      if (!guided[i].log || !failures_[i].empty()) continue;
      double* row = guided[i].log + static_cast<std::size_t>(guided[i].rows) * (1 + columns);
      *row = time(i);
      std::copy_n(&states[i * state_width()], columns, row + 1);
      ++guided[i].rows;
    }
  }

  /// Take the state of a vehicle over from its simulation.
  void settle(std::size_t i) {
    Member& member = members_[i];
    Simulation& simulation = *member.apart;
    const Snapshot flown = simulation.snapshot();
    steps_[i] = flown.steps;
    member.hear(flown.warnings);
    if (!member.in_lanes) return;
    lanes_->set_engine_state(i, flown.engine);
    lanes_->let_fly(i, failures_[i].empty());
    lanes_->lift_bounds(i, simulation.force_laws().quiet);
  }

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

Batch::Batch(std::vector<BatchVehicle> vehicles, const World& world,
             const SimulationOptions& options, unsigned threads)
    : implementation_(
          std::make_unique<Implementation>(std::move(vehicles), world, options, threads)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;

void Batch::follow_together(const CommandAll& command_all, double rate, double delay,
                            const std::string& odometry, std::int64_t steps, std::int64_t log_every,
                            std::vector<BatchGuided>& guided) {
  implementation_->follow_together(command_all, rate, delay, odometry, steps, log_every, guided);
}

std::size_t Batch::size() const { return implementation_->size(); }
std::size_t Batch::command_width() const { return implementation_->command_width(); }
std::size_t Batch::state_width() const { return implementation_->state_width(); }
double Batch::dt() const { return implementation_->dt(); }
void Batch::follow(const std::vector<BatchGuide>& guides, const std::string& odometry,
                   std::int64_t steps, std::int64_t log_every, std::vector<BatchGuided>& guided,
                   const std::function<void()>& poll) {
  implementation_->follow(guides, odometry, steps, log_every, guided, poll);
}
void Batch::step(const double* commands, std::int64_t count) {
  implementation_->step(commands, count);
}
void Batch::get_state(double* rows) const { implementation_->get_state(rows); }
void Batch::set_state(const double* rows) { implementation_->set_state(rows); }
double Batch::time(std::size_t vehicle) const { return implementation_->time(vehicle); }
const std::vector<std::string>& Batch::failures() const { return implementation_->failures(); }
const std::vector<std::string>& Batch::warnings(std::size_t vehicle) const {
  return implementation_->warnings(vehicle);
}
void Batch::reset(const bool* mask, const std::uint64_t* seeds) {
  implementation_->reset(mask, seeds);
}
BatchSnapshot Batch::snapshot() const { return implementation_->snapshot(); }
void Batch::restore(const BatchSnapshot& snapshot) { implementation_->restore(snapshot); }

}  // namespace quadcore
