#include "flight_checks.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/random.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore {

Snapshot Simulation::snapshot() const {
  const auto of_flight = warnings_.begin() + static_cast<std::ptrdiff_t>(warnings_at_load_);
  return {fingerprint_,
          start_time_,
          steps_,
          seed_,
          engine_->save(),
          plugin_state_,
          topics_.messages(),
          {of_flight, warnings_.end()},
          failure_};
}

void Simulation::restore(const Snapshot& snapshot, const Allowed& allowed) {
  if (snapshot.taken_from != fingerprint_) {
    check_snapshot(snapshot, plugin_state_.size());
    check_same(*snapshot.taken_from, *fingerprint_, allowed);
  }
  topics_.check(snapshot.messages);
  std::unique_ptr<Engine> engine;
  try {
    engine = another_engine(snapshot.plugin_state);
  } catch (...) {
    const std::string why = blamed();
    leave();
    throw InputError(why);
  }
  (engine ? *engine : *engine_).restore(snapshot.engine);
  if (engine) change_to(std::move(engine));
  start_time_ = snapshot.start_time;
  steps_ = snapshot.steps;
  plant_seed(snapshot.seed);
  plugin_state_ = snapshot.plugin_state;
  topics_.restore(snapshot.messages);
  warnings_.resize(warnings_at_load_);
  warnings_.insert(warnings_.end(), snapshot.warnings.begin(), snapshot.warnings.end());
  failure_ = snapshot.failure;
  try {
    show_instant();
    show_state();
  } catch (...) {
    fail(what_was_thrown());
  }
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
