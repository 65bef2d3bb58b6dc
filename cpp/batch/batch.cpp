#include "quadcore/batch.hpp"

#include <algorithm>

#include "lane_blocks.hpp"
#include "members.hpp"
#include "quadcore/plugin/error.hpp"
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
    batch::Crew crew = batch::make_crew(std::move(vehicles), common_);
    members_ = std::move(crew.members);
    steps_.resize(size());
    is_apart_.resize(size());
    is_commanded_.resize(size());
    commands_.resize(size() * command_width());
    failures_.resize(size());
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
    std::unique_ptr<Simulation> alike;  // of the previous vehicle
    for (std::size_t i = 0; i < size(); ++i) {
      Member& member = members_[i];
      failures_[i].clear();
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
    steps_[i] = 0;
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
  std::vector<std::string> failures_;
  std::unique_ptr<LaneBlocks> lanes_;
};

Batch::Batch(std::vector<BatchVehicle> vehicles, const World& world,
             const SimulationOptions& options, unsigned threads)
    : implementation_(
          std::make_unique<Implementation>(std::move(vehicles), world, options, threads)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;

std::size_t Batch::size() const { return implementation_->size(); }
std::size_t Batch::command_width() const { return implementation_->command_width(); }
std::size_t Batch::state_width() const { return implementation_->state_width(); }
double Batch::dt() const { return implementation_->dt(); }
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
