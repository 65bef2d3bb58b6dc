#include <algorithm>
#include <utility>

#include "flight_checks.hpp"
#include "laden_model.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

/// Return whether a motion is within the bounds.
bool holds(const Quiet& quiet, const Kinematics& motion) {
  const RotorMotions& rotors = motion.rotors;
  if (quiet.bounds_rates() && !rotors.slower_than(quiet.fastest)) return false;
  if (!quiet.bounds_tilt()) return true;
  const Vector3d up_F = motion.R_WF.row(2);
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    if (!(up_F.dot(rotors.vector(MotionRow::normal, i)) >= 0)) return false;
  }
  return true;
}

}  // namespace

void Simulation::note_hooks() {
  for (const std::size_t i : topics_.settle()) {
    const LoadedPlugin& p = plugins_[i];
    const Hooks& hooks = p.descriptor->create.hooks;
    if (hooks.observe) with_.observe.push_back(&p);
    if (hooks.update) with_.update.push_back(&p);
    if (hooks.sense) with_.sense.push_back(&p);
  }
  std::vector<bool> updating;
  for (const LoadedPlugin& p : plugins_) {
    const Hooks& hooks = p.descriptor->create.hooks;
    updating.push_back(hooks.update);
    if (hooks.forces) with_.forces.push_back(&p);
    if (hooks.forces && !hooks.laws) with_.forces_without_laws.push_back(&p);
    if (hooks.air) with_.air.push_back(&p);
    if (hooks.carried) with_.carried.push_back(&p);
  }
  topics_.note_updates(updating);
  windy_ = !world_.wind_W.isZero(0) || !with_.air.empty();
}

void Simulation::gather_laws() {
  std::vector<const LoadedPlugin*> bounded;
  for (LoadedPlugin& p : plugins_) {
    if (!p.descriptor->create.hooks.laws) continue;
    active_ = &p;
    p.quiet = laws_.quiet.size();
    p.plugin->laws(std::as_const(*this).state_of(p), laws_);
    if (laws_.quiet.size() == p.quiet + 1) bounded.push_back(&p);
  }
  active_ = nullptr;
  laws_.complete = !windy_ && with_.forces_without_laws.empty();
  const auto is_bounded = [&bounded](const LoadedPlugin* p) {
    return std::find(bounded.begin(), bounded.end(), p) != bounded.end();
  };
  laws_.all_quiet = laws_.complete && with_.carried.empty() &&
                    std::all_of(with_.update.begin(), with_.update.end(), is_bounded);
}

void Simulation::show_instant() {
  Kinematics& kinematics = engine_->kinematics();
  kinematics.time = time();
  if (windy_) blow(kinematics);
}

void Simulation::blow(Kinematics& kinematics) const {
  Vector3d v_WA_W = world_.wind_W;
  kinematics.v_WA_F.setZero();
  for (const LoadedPlugin* const p : with_.air) {
    active_ = p;
    p->plugin->air(kinematics, state_of(*p), v_WA_W);
    if (!v_WA_W.allFinite()) throw Error("the velocity of the air is not a finite number");
  }
  active_ = nullptr;
  kinematics.v_WA_F = kinematics.R_WF.transpose() * v_WA_W;
}

void Simulation::evaluate(Kinematics& kinematics, Loads& loads) const {
  if (windy_) blow(kinematics);
  push(with_.forces, kinematics, loads);
}

void Simulation::evaluate_rest(Kinematics& kinematics, Loads& loads) const {
  if (windy_) blow(kinematics);
  push(with_.forces_without_laws, kinematics, loads);
}

void Simulation::push(const std::vector<const LoadedPlugin*>& plugins, const Kinematics& kinematics,
                      Loads& loads) const {
  Wrench* const terms = loads.terms();
  for (const LoadedPlugin* const p : plugins) {
    if (terms) {
      loads.record_terms(terms + p->term_begin, p->descriptor->wrenches.size(), &kinematics);
    }
    active_ = p;
    p->plugin->forces(kinematics, state_of(*p), loads);
  }
  active_ = nullptr;
}

void Simulation::refuse(const Kinematics& kinematics, Loads& loads) const {
  if (!is_finite(kinematics)) throw Error(no_longer_finite + advice());
  // Force laws are pure functions: evaluated one by one, the same one fails again.
  loads.clear();
  loads.record_terms(nullptr, 0, nullptr);
  for (const LoadedPlugin* const p : with_.forces) {
    active_ = p;
    p->plugin->forces(kinematics, state_of(*p), loads);
    if (!loads.all_finite()) break;
  }
  ForceField::refuse(kinematics, loads);
}

std::unique_ptr<Engine> Simulation::another_engine(const VectorXd& plugin_state) {
  if (with_.carried.empty()) return nullptr;
  asked_.clear();
  bool changed = false;
  for (const LoadedPlugin* const p : with_.carried) {
    active_ = p;
    std::size_t i = asked_.size();
    p->plugin->carried({plugin_state.data() + p->state_begin, p->state_size}, asked_);
    for (; i < asked_.size(); ++i) {
      if (i < carried_.size() && asked_[i] == carried_[i]) continue;
      check_carried(asked_, i, model_);
      changed = true;
    }
  }
  active_ = nullptr;
  if (!changed && asked_.size() == carried_.size()) return nullptr;
  return create_engine(with_carried(model_, asked_));
}

void Simulation::change_to(std::unique_ptr<Engine> engine) {
  engine_ = std::move(engine);
  description_.reset();
  carried_ = asked_;
}

void Simulation::take_along() {
  std::unique_ptr<Engine> engine = another_engine(plugin_state_);
  if (!engine) return;
  engine_->get_state(state_);
  engine->set_state(state_);
  change_to(std::move(engine));
  show_instant();
}

const std::vector<Wrench>& Simulation::wrenches() {
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  wrench_loads_.clear();
  wrench_loads_.record_terms(wrenches_.data(), wrenches_.size(), &engine_->kinematics());
  try {
    evaluate(engine_->kinematics(), wrench_loads_);
  } catch (...) {
    fail(what_was_thrown());
  }
  return wrenches_;
}

template <class Call>
void Simulation::sample(const std::vector<const LoadedPlugin*>& plugins, bool jumped,
                        const Call& call) {
  Sample sample{time(), dt_, engine_->kinematics(), world_, topics_, said_, 0, jumped};
  topics_.begin_sample();
  for (const LoadedPlugin* const p : plugins) {
    enter(*p);
    sample.seed = p->seed;
    call(*p->plugin, sample, state_of(*p));
    if (!said_.empty()) collect_warnings();
  }
  leave();
}

void Simulation::sense(bool jumped) {
  sample(with_.sense, jumped, [](const Plugin& plugin, const Sample& sample, PluginState state) {
    plugin.sense(sample, state);
  });
}

bool Simulation::is_quiet(const LoadedPlugin& p, std::uint64_t news) const {
  const auto index = static_cast<std::size_t>(&p - plugins_.data());
  return laws_.all_quiet && (news & Topics::set_of(index)) == 0 &&
         holds(laws_.quiet[p.quiet], engine_->kinematics());
}

bool Simulation::are_quiet() const {
  if (!laws_.all_quiet || topics_.news() != 0) return false;
  return std::all_of(with_.update.begin(), with_.update.end(),
                     [this](const LoadedPlugin* p) { return is_quiet(*p, 0); });
}

void Simulation::update() {
  const std::uint64_t news = topics_.take_news();
  sample(with_.update, false, [&](const Plugin& plugin, const Sample& sample, PluginState state) {
    if (!is_quiet(*active_, news | topics_.news())) plugin.update(sample, state);
  });
}

void Simulation::observe(const OtherVehicles& others) {
  sample(with_.observe, false,
         [&others](const Plugin& plugin, const Sample& sample, PluginState state) {
           plugin.observe(sample, others, state);
         });
}

void Simulation::show_to_others(OtherVehicle& seen) {
  Kinematics& k = engine_->kinematics();
  wrench_loads_.clear();
  wrench_loads_.record_terms(nullptr, 0, nullptr);
  evaluate(k, wrench_loads_);
  if (!wrench_loads_.all_finite()) refuse(k, wrench_loads_);
  seen.p_WF = k.p_WF;
  seen.R_WF = k.R_WF;
  seen.v_WF_W = k.R_WF * k.v_WF_F;
  seen.w_WF_W = k.R_WF * k.w_WF_F;
  seen.rotors.resize(k.rotors.size());
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    const Vector3d p_FRcm_F = k.rotors.vector(MotionRow::p_FRcm, i);
    seen.rotors[i] = {k.p_WF + k.R_WF * p_FRcm_F, k.R_WF * wrench_loads_.rotor_force_F(i),
                      radii_[i]};
  }
}

void Simulation::collect_warnings() {
  for (const std::string& what : said_) {
    warnings_.push_back("t = " + seconds(time()) + ": plugin '" + active_->name + "': " + what);
  }
  said_.clear();
}

}  // namespace quadcore
