#include "batch_implementation.hpp"

#include "quadcore/plugin/error.hpp"

namespace quadcore {

Batch::Implementation::Implementation(std::vector<BatchVehicle> vehicles, const World& world,
                                      const SimulationOptions& options, unsigned threads)
    : common_(world, options), threads_(threads) {
  if (world.start_time != 0) {
    throw InputError(
        "a batch cannot start at the time of a saved world. Remove <state> from the world, or "
        "simulate each vehicle alone.");
  }
  batch::Members all = batch::make_members(std::move(vehicles), common_);
  members_ = std::move(all.members);
  steps_.resize(size());
  is_apart_.resize(size());
  is_commanded_.resize(size());
  commands_.resize(size() * command_width());
  failures_.resize(size());
  placements_.resize(size());
  lanes_ = std::make_unique<LaneBlocks>(all.in_lanes, common_.rotors(), world);
  for (std::size_t i = 0; i < size(); ++i) begin(i);
}

void Batch::Implementation::step(const double* commands, std::int64_t count) {
  if (count < 0)
    throw InputError("the step count is " + std::to_string(count) + ". Give a whole number >= 0.");
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
        continue_apart(i, commands, count - flown[i - first]);
      } else if (count > 0 && is_apart_[i]) {
        return_to_lanes(i);
      }
    }
  });
}

void Batch::Implementation::begin(std::size_t i) {
  Member& member = members_[i];
  steps_[i] = placements_[i] = 0;
  is_commanded_[i] = false;
  failures_[i].clear();
  member.warnings.resize(member.warned_at_load);
  if (member.in_lanes) {
    return_to_lanes(i);
    lanes_->begin(i, member.start);
  } else {
    simulate_apart(i).reset(member.vehicle.seed);
  }
}

Simulation& Batch::Implementation::simulate_apart(std::size_t i) {
  if (!members_[i].apart) members_[i].apart = common_.simulate(members_[i].vehicle);
  is_apart_[i] = true;
  return *members_[i].apart;
}

void Batch::Implementation::return_to_lanes(std::size_t i) {
  if (!members_[i].in_lanes) return;
  members_[i].apart.reset();
  is_apart_[i] = false;
}

void Batch::Implementation::continue_apart(std::size_t i, bool has_commands, std::int64_t steps) {
  Member& member = members_[i];
  Simulation& simulation = simulate_apart(i);
  if (member.in_lanes) {
    Snapshot now = simulation.snapshot();
    lanes_->get_engine_state(i, now.engine);
    now.steps = steps_[i];
    simulation.restore(now);
  }
  try {
    // For a vehicle that is never in the lanes, the simulation stores the command and its time.
    const bool lacks_command = member.in_lanes && is_commanded_[i];
    if (has_commands || lacks_command) simulation.command(command_of(i), command_width());
    simulation.step(steps);
  } catch (const FlightError& error) {
    failures_[i] = error.what();
  }
  store_simulation(i);
}

void Batch::Implementation::store_simulation(std::size_t i) {
  Member& member = members_[i];
  Simulation& simulation = *member.apart;
  const Snapshot flown = simulation.snapshot();
  steps_[i] = flown.steps;
  member.add_warnings(flown.warnings);
  if (!member.in_lanes) return;
  lanes_->set_engine_state(i, flown.engine);
  lanes_->let_fly(i, failures_[i].empty());
  lanes_->lift_bounds(i, simulation.force_laws().quiet);
}

}  // namespace quadcore
