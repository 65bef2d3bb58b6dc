#include <sstream>

#include "quadcore/error.hpp"
#include "quadcore/random.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore {

/// What a snapshot and the simulation that it is restored to must have in common.
std::string Simulation::describe_kind() const {
  std::ostringstream kind;
  kind.precision(17);
  kind << engine_name_ << ' ' << dt_ << ' ' << model_.name;
  for (const Link& link : model_.links) kind << '|' << link.name << ' ' << link.inertial.mass;
  for (const Joint& joint : model_.joints) kind << '|' << joint.name;
  for (const LoadedPlugin& p : plugins_) {
    kind << '|' << p.name << ' ' << p.path << ' ' << p.state_size;
  }
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    kind << '|' << topics_[i].name << ' ' << joined(topics_[i].fields);
  }
  return kind.str();
}

Snapshot Simulation::snapshot() const {
  const auto of_flight = warnings_.begin() + static_cast<std::ptrdiff_t>(warnings_at_load_);
  return {kind_,           start_time_,   steps_,  seed_,
          engine_->save(), plugin_state_, topics_, {of_flight, warnings_.end()},
          failure_};
}

void Simulation::restore(const Snapshot& snapshot) {
  if (snapshot.kind != kind_) {
    throw InputError(
        "snapshot: was taken from another engine, step or model; restore one of this simulation");
  }
  try {
    take_along(snapshot.plugin_state);
  } catch (...) {
    fail(what_was_thrown());
  }
  engine_->restore(snapshot.engine);
  start_time_ = snapshot.start_time;
  steps_ = snapshot.steps;
  plant_seed(snapshot.seed);
  plugin_state_ = snapshot.plugin_state;
  topics_ = snapshot.topics;
  warnings_.resize(warnings_at_load_);
  warnings_.insert(warnings_.end(), snapshot.warnings.begin(), snapshot.warnings.end());
  failure_ = snapshot.failure;
  show_instant();
  show_state();
}

void Simulation::reset(std::uint64_t seed) {
  restore(initial_);
  plant_seed(seed);
  begin();
}

void Simulation::plant_seed(std::uint64_t seed) {
  seed_ = seed;
  for (LoadedPlugin& p : plugins_) p.seed = stream_seed(seed, p.name);
}

}  // namespace quadcore
