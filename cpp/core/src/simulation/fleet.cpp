#include "quadcore/fleet.hpp"

#include <algorithm>

#include "laden_model.hpp"
#include "quadcore/fingerprint.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

void check_same_world(const Simulation& one, const Simulation& other, const std::string& name) {
  const Fingerprint &here = one.fingerprint(), &there = other.fingerprint();
  std::string what;
  if (here.engine != there.engine) what = "engine";
  if (here.step != there.step) what = "step";
  if (here.world != there.world) what = "world";
  if (what.empty()) return;
  throw InputError("vehicle '" + name + "': its " + what +
                   " is not that of the first vehicle. Give all vehicles the same " + what + ".");
}

}  // namespace

Fleet::Fleet(std::vector<Simulation*> vehicles, std::vector<std::string> names)
    : vehicles_(std::move(vehicles)), names_(std::move(names)) {
  if (vehicles_.empty() || names_.size() != vehicles_.size()) {
    throw InputError("a fleet needs vehicles, each with a name. Give at least one.");
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    check_same_world(*vehicles_.front(), *vehicles_[i], names_[i]);
    if (vehicles_[i]->in_fleet_) {
      throw InputError("vehicle '" + names_[i] +
                       "' already belongs to a fleet. Make a simulation for each vehicle.");
    }
    if (vehicles_[i]->motion_) {
      throw InputError("vehicle '" + names_[i] + "': its engine cannot share a world. Use " +
                       "gazebo11, ode or eigen.");
    }
  }
  engines_.resize(vehicles_.size());
  forces_.resize(vehicles_.size());
  try {
    for (Simulation* const vehicle : vehicles_) remake(*vehicle, true);
    share();
  } catch (...) {
    for (Simulation* const vehicle : vehicles_) remake(*vehicle, false);
    throw;
  }
  initial_ = shared_->save();
  const auto observes = [](const Simulation* vehicle) { return vehicle->observes(); };
  if (std::none_of(vehicles_.begin(), vehicles_.end(), observes)) return;
  seen_.resize(vehicles_.size());
  others_.resize(vehicles_.size());
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    seen_[i].name = names_[i];
    for (std::size_t k = 0; k < vehicles_.size(); ++k) {
      if (k != i) others_[i].push_back(&seen_[k]);
    }
  }
}

void Fleet::look_around() {
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    blame(i, [&] { vehicles_[i]->show_to_others(seen_[i]); });
  }
  throw_failure();
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    blame(i, [&] { vehicles_[i]->observe(others_[i]); });
  }
}

void Fleet::remake(Simulation& vehicle, bool in_fleet) {
  vehicle.reset();
  vehicle.in_fleet_ = in_fleet;
  const Model& model = vehicle.model_;
  vehicle.engine_ = vehicle.create_engine(
      vehicle.carried_.empty() ? model : with_carried(model, vehicle.carried_));
  vehicle.engine_->set_state(vehicle.start_);
  vehicle.initial_.engine = vehicle.engine_->save();
  vehicle.reset();
}

void Fleet::share() {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) engines_[i] = vehicles_[i]->engine_.get();
  shared_ = share_world(vehicles_.front()->engine_name_, engines_, vehicles_.front()->world_);
}

void Fleet::follow_engines() {
  bool changed = false;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    changed |= vehicles_[i]->engine_.get() != engines_[i];
  }
  if (!changed) return;
  const std::vector<double> saved = shared_->save();
  share();
  shared_->restore(saved);
}

void Fleet::step() {
  if (!failure_.empty()) {
    throw FlightError(vehicles_.front()->time(), failure_ + (failure_.back() == '.' ? "" : ".") +
                                                     " To continue, call reset or restore.");
  }
  look_around();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    blame(i, [&] { vehicles_[i]->begin_step(); });
    forces_[i] = {vehicles_[i]->time(), vehicles_[i]};
  }
  throw_failure();
  follow_engines();
  try {
    shared_->step(vehicles_.front()->dt(), forces_);
  } catch (...) {
    blame(shared_->current(), [] { throw; });
  }
  throw_failure();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    blame(i, [&] {
      vehicles_[i]->end_step();
      vehicles_[i]->show_state();
    });
  }
  throw_failure();
}

template <class Act>
void Fleet::blame(std::size_t vehicle, const Act& act) {
  try {
    act();
  } catch (...) {
    try {
      vehicles_[vehicle]->fail(what_was_thrown());
    } catch (const FlightError& error) {
      if (failure_.empty()) failure_ = "vehicle '" + names_[vehicle] + "': " + error.what();
    }
  }
}

void Fleet::throw_failure() const {
  if (!failure_.empty()) throw FlightError(vehicles_.front()->time(), failure_);
}

FleetSnapshot Fleet::snapshot() const {
  FleetSnapshot snapshot;
  for (const Simulation* const vehicle : vehicles_) {
    snapshot.vehicles.push_back(vehicle->snapshot());
  }
  snapshot.world = shared_->save();
  snapshot.failure = failure_;
  return snapshot;
}

void Fleet::restore(const FleetSnapshot& snapshot) {
  if (snapshot.vehicles.size() != vehicles_.size()) {
    throw InputError("snapshot: it has " + std::to_string(snapshot.vehicles.size()) +
                     " vehicles, the fleet has " + std::to_string(vehicles_.size()) +
                     ". Restore a snapshot of this fleet.");
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    check_same(*snapshot.vehicles[i].taken_from, vehicles_[i]->fingerprint(), {});
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) vehicles_[i]->restore(snapshot.vehicles[i]);
  follow_engines();
  shared_->restore(snapshot.world);
  failure_ = snapshot.failure;
}

void Fleet::reset() {
  for (Simulation* const vehicle : vehicles_) vehicle->reset();
  follow_engines();
  shared_->restore(initial_);
  failure_.clear();
}

std::unique_ptr<Engine> Simulation::create_engine(const Model& model) const {
  if (!in_fleet_ || world_.free_bodies.empty()) return make_engine(engine_name_, model, world_);
  World world = world_;
  world.free_bodies.clear();
  world.free_joints.clear();
  return make_engine(engine_name_, model, world);
}

}  // namespace quadcore
