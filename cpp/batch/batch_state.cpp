#include "batch_implementation.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {

void Batch::Implementation::get_state(double* rows) const {
  for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
    lanes_->show(block, end - first, work, rows + first * state_width());
    for (std::size_t i = first; i < end; ++i) {
      if (!is_apart_[i] || (members_[i].in_lanes && failures_[i].empty())) continue;
      batch::put(members_[i].apart->state(), rows + i * state_width());
    }
  });
}

void Batch::Implementation::set_state(const double* rows) {
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

void Batch::Implementation::reset(const bool* mask, const std::uint64_t* seeds) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!mask[i]) continue;
    if (seeds) members_[i].made_of.seed = seeds[i];
    begin(i);
  }
}

BatchSnapshot Batch::Implementation::snapshot() const {
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

void Batch::Implementation::restore(const BatchSnapshot& snapshot) {
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

}  // namespace quadcore
