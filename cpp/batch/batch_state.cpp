#include "batch_implementation.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {

void Batch::Implementation::get_state(double* rows) const {
  for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
    lanes_->show(block, end - first, work, rows + first * state_width());
    for (std::size_t i = first; i < end; ++i) {
      if (!is_apart_[i] || (members_[i].in_lanes && failures_[i].empty())) continue;
      batch::write_state(members_[i].apart->state(), rows + i * state_width());
    }
  });
}

void Batch::Implementation::set_state(const double* rows) {
  const auto rotors = static_cast<Eigen::Index>(common_.rotors());
  std::vector<VehicleState> states;
  for (std::size_t i = 0; i < size(); ++i) {
    states.push_back(batch::read_state(rows + i * state_width(), rotors));
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
      simulate_apart(i).set_state(states[i]);
      continue;
    }
    return_to_lanes(i);
    if (!alike || !batch::are_built_alike(member.vehicle, members_[i - 1].vehicle)) {
      alike = common_.simulate(member.vehicle);
    }
    alike->set_state(states[i]);
    lanes_->set_engine_state(i, alike->snapshot().engine);
    lanes_->let_fly(i, true);
  }
}

void Batch::Implementation::reset(const bool* mask, const std::uint64_t* seeds) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!mask[i]) continue;
    if (seeds) members_[i].vehicle.seed = seeds[i];
    begin(i);
  }
}

BatchSnapshot Batch::Implementation::snapshot() const {
  auto content = std::make_shared<BatchSnapshot::Content>();
  content->batch = identity_;
  content->lanes = lanes_->save();
  content->steps = steps_;
  content->commands = commands_;
  content->is_commanded = is_commanded_;
  content->failures = failures_;
  content->placements = placements_;
  content->places = places_;
  for (const Member& member : members_) {
    content->vehicles.push_back({member.vehicle.seed, member.warnings, {}});
    if (member.apart) content->vehicles.back().apart = member.apart->snapshot();
  }
  return {content};
}

void Batch::Implementation::restore(const BatchSnapshot& snapshot) {
  const BatchSnapshot::Content& content = *snapshot.content;
  if (content.batch != identity_)
    throw InputError(
        "snapshot: it was taken from another batch. Restore a snapshot of this batch.");
  lanes_->restore(content.lanes);
  steps_ = content.steps;
  commands_ = content.commands;
  is_commanded_ = content.is_commanded;
  failures_ = content.failures;
  placements_ = content.placements;
  places_ = content.places;
  for (std::size_t i = 0; i < size(); ++i) {
    members_[i].vehicle.seed = content.vehicles[i].seed;
    members_[i].warnings = content.vehicles[i].warnings;
    if (content.vehicles[i].apart) {
      simulate_apart(i).restore(*content.vehicles[i].apart);
    } else {
      return_to_lanes(i);
    }
  }
}

}  // namespace quadcore
