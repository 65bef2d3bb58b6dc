#include "quadcore/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr const char* command_topic_name = "vel_cmd";
/// Below this no flight would end.
constexpr double min_dt = 1e-9;         // s
/// Beyond these no flight is meant; the numbers only say "diverged" before they overflow.
constexpr double max_speed = 1e6;       // m/s
constexpr double max_rate = 1e6;        // rad/s
constexpr double max_distance = 1e9;    // m
/// Numbers of state that a plugin may ask for.
constexpr std::size_t max_plugin_state = 1000000;
constexpr const char* no_longer_finite =
    "the state is no longer finite; try a smaller step or weaker commands";

bool is_finite(const Kinematics& k) {
  double rates = 0;
  for (const RotorKinematics& rotor : k.rotors) rates += rotor.rate;
  return k.p_WF.allFinite() && k.q_WF.coeffs().allFinite() && k.v_WF_F.allFinite() &&
         k.w_WF_F.allFinite() && std::isfinite(rates);
}

/// "PLUGIN.TAG" -> value becomes PLUGIN -> (TAG -> value); unknown plugins are refused.
std::map<std::string, std::map<std::string, std::string>> by_plugin(
    const std::map<std::string, std::string>& parameters, const Model& model) {
  std::vector<std::string> names;
  for (const PluginElement& element : model.plugins) names.push_back(element.name);
  std::map<std::string, std::map<std::string, std::string>> result;
  for (const auto& [key, value] : parameters) {
    const auto dot = key.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == key.size()) {
      throw InputError("set " + key + ": is not PLUGIN.TAG; write, for example, " +
                       (names.empty() ? "plugin" : names.front()) + ".sim_slow");
    }
    const std::string plugin = key.substr(0, dot);
    if (std::find(names.begin(), names.end(), plugin) == names.end()) {
      throw InputError("set " + key + ": the model has no plugin '" + plugin + "'" +
                       did_you_mean(plugin, names) + "; it has " + joined(names));
    }
    result[plugin][key.substr(dot + 1)] = value;
  }
  return result;
}

/// A shared tag must mean the same in every plugin that has it.
void check_shared_tags(const std::vector<LoadedPlugin>& plugins) {
  std::map<std::string, std::pair<const LoadedPlugin*, const Parameter*>> first;
  for (const LoadedPlugin& plugin : plugins) {
    for (const Parameter& parameter : plugin.parameters.all()) {
      if (!parameter.spec.shared) continue;
      const auto [known, added] =
          first.emplace(parameter.spec.name, std::pair{&plugin, &parameter});
      const Parameter& other = *known->second.second;
      if (added || other.number == parameter.number) continue;
      const auto describe = [](const LoadedPlugin& p, const Parameter& value) {
        return value.text + " in '" + p.name + "' (" + value.origin + ")";
      };
      const Parameter& blamed = parameter.origin == "default" ? other : parameter;
      throw InputError((blamed.origin == "set" ? "set <" + blamed.spec.name + ">" : blamed.origin) +
                       ": <" + parameter.spec.name + "> is " +
                       describe(*known->second.first, other) + " but " +
                       describe(plugin, parameter) + "; give both the same value");
    }
  }
}

}  // namespace

Simulation::Simulation(Model model, const World& world, const SimulationOptions& options)
    : engine_name_(options.engine),
      dt_(options.dt.value_or(world.max_step_size)),
      warnings_(model.warnings),
      wrench_loads_(model.joints.size()) {
  if (!(dt_ >= min_dt && std::isfinite(dt_))) {
    std::ostringstream what;
    what << (options.dt ? "dt" : "the world's <max_step_size>") << " is " << dt_
         << "; write a step in s, from " << min_dt << " up";
    throw InputError(what.str());
  }
  if (!options.spawn.xyz.allFinite() || !options.spawn.rpy.allFinite()) {
    throw InputError("spawn holds a number that is not finite; write x,y,z[,roll,pitch,yaw]");
  }
  load_plugins(model, options);
  check_shared_tags(plugins_);
  engine_ = make_engine(options.engine, model, world);
  command_topic_ = topics_.find(command_topic_name);
  kind_ = describe_kind();

  const auto n = static_cast<Eigen::Index>(model.joints.size());
  state_.rotor_velocity = VectorXd::Zero(n);
  state_.rotor_angle = VectorXd::Zero(n);
  VehicleState start = state_;
  start.position = options.spawn.xyz;
  start.orientation = options.spawn.rotation();
  set_state(start);
  initial_ = snapshot();
}

void Simulation::load_plugins(const Model& model, const SimulationOptions& options) {
  const auto overrides = by_plugin(options.parameters, model);
  Eigen::Index state_size = 0;
  for (const PluginElement& element : model.plugins) {
    const PluginLibrary library = open_plugin(element);
    const auto given = overrides.find(element.name);
    LoadedPlugin loaded{element.name,
                        element.filename,
                        library.path,
                        library.descriptor,
                        Parameters(library.descriptor->tags, element, model,
                                   given == overrides.end() ? std::map<std::string, std::string>{}
                                                            : given->second),
                        nullptr};
    const std::string who = element.where + ": plugin '" + element.name + "'";
    for (const std::string& term : library.descriptor->wrenches) {
      if (std::find(wrench_terms_.begin(), wrench_terms_.end(), term) != wrench_terms_.end()) {
        throw InputError(who + " reports the wrench '" + term +
                         "', which another plugin reports already; load only one of them");
      }
    }
    loaded.state_begin = state_size;
    try {
      std::vector<std::string> warnings;
      loaded.plugin = library.descriptor->create(
          {element.name, loaded.parameters, model, topics_, options.seed, warnings});
      if (!loaded.plugin) throw Error("its create() returned no plugin");
      const std::size_t numbers = loaded.plugin->state_size();
      if (numbers > max_plugin_state) {
        throw Error("its state_size() is " + std::to_string(numbers) + "; ask for at most " +
                    std::to_string(max_plugin_state));
      }
      loaded.state_size = static_cast<Eigen::Index>(numbers);
      for (const std::string& warning : warnings) warnings_.push_back(who + ": " + warning);
    } catch (...) {
      throw InputError(who + " (" + library.path + "): " + what_was_thrown());
    }
    state_size += loaded.state_size;
    loaded.term_begin = wrench_terms_.size();
    wrench_terms_.insert(wrench_terms_.end(), library.descriptor->wrenches.begin(),
                         library.descriptor->wrenches.end());
    plugins_.push_back(std::move(loaded));
  }
  plugin_state_ = VectorXd::Zero(state_size);
  wrenches_.resize(wrench_terms_.size());
}

std::size_t Simulation::command_width() const {
  if (command_topic_ < 0) {
    throw InputError("no plugin of model '" + model().name +
                     "' listens to commands; add libmotorpid_plugin.so");
  }
  return topics_[static_cast<std::size_t>(command_topic_)].values.size();
}

void Simulation::command(const double* speeds, std::size_t count) {
  const std::size_t width = command_width();
  if (count != width) {
    throw InputError("command holds " + std::to_string(count) + " rotor speeds; give " +
                     std::to_string(width));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(speeds[i])) {
      throw InputError("command for rotor " + std::to_string(i + 1) +
                       " is not a finite number; give rad/s");
    }
  }
  const auto topic = static_cast<std::size_t>(command_topic_);
  std::copy(speeds, speeds + count, topics_.values(topic).begin());
  topics_.publish(topic, time());
}

void Simulation::evaluate(const Kinematics& kinematics, Loads& loads) const {
  Wrench* const terms = loads.terms();
  for (const LoadedPlugin& p : plugins_) {
    if (terms) {
      loads.record_terms(terms + p.term_begin, p.descriptor->wrenches.size(), &kinematics);
    }
    active_ = &p;
    p.plugin->forces(kinematics, {plugin_state_.data() + p.state_begin, p.state_size}, loads);
  }
  active_ = nullptr;
}

void Simulation::refuse(const Kinematics& kinematics, Loads& loads) const {
  if (!is_finite(kinematics)) throw Error(no_longer_finite);
  // Force laws are pure: asked again one by one, the same one spoils the sum.
  loads.clear();
  loads.record_terms(nullptr, 0, nullptr);
  for (const LoadedPlugin& p : plugins_) {
    active_ = &p;
    p.plugin->forces(kinematics, {plugin_state_.data() + p.state_begin, p.state_size}, loads);
    if (!loads.all_finite()) break;
  }
  ForceField::refuse(kinematics, loads);
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

void Simulation::sense(bool jumped) {
  const Sample sample{time(), dt_, engine_->kinematics(), topics_, jumped};
  for (const LoadedPlugin& p : plugins_) {
    active_ = &p;
    p.plugin->sense(sample, state_of(p));
  }
  active_ = nullptr;
}

void Simulation::update() {
  const Sample sample{time(), dt_, engine_->kinematics(), topics_};
  for (const LoadedPlugin& p : plugins_) {
    active_ = &p;
    p.plugin->update(sample, state_of(p));
  }
  active_ = nullptr;
}

void Simulation::step(std::int64_t n) {
  if (n < 0) throw InputError("step count is " + std::to_string(n) + "; give one >= 0");
  if (!failure_.empty()) {
    throw FlightError(time(), failure_ + "; reset, restore or set a state to go on");
  }
  try {
    for (; n > 0; --n) {
      update();
      engine_->step(dt_, *this);
      ++steps_;
      check_flight();
      sense(false);
    }
    show_state();
  } catch (...) {
    fail(what_was_thrown());
  }
}

void Simulation::fail(const std::string& what) {
  failure_ = "the flight failed at t = " + std::to_string(time()) + " s: ";
  if (active_) failure_ += "plugin '" + active_->name + "' (" + active_->path + "): ";
  failure_ += what;
  active_ = nullptr;
  show_state();
  throw FlightError(time(), failure_);
}

void Simulation::show_state() {
  engine_->get_state(state_);
  state_.time = time();
}

void Simulation::check_flight() const {
  const Kinematics& k = engine_->kinematics();
  // Comparisons are written so that NaN fails them.
  bool sane = k.p_WF.squaredNorm() < max_distance * max_distance && k.q_WF.squaredNorm() < 2 &&
              k.v_WF_F.squaredNorm() < max_speed * max_speed &&
              k.w_WF_F.squaredNorm() < max_rate * max_rate;
  for (const RotorKinematics& rotor : k.rotors) sane = sane && std::abs(rotor.rate) < max_rate;
  if (sane) return;
  throw Error(is_finite(k) ? "the motion diverged; try a smaller step or weaker commands"
                           : no_longer_finite);
}

void Simulation::set_state(const VehicleState& state) {
  const auto n = state_.rotor_velocity.size();
  if (state.rotor_velocity.size() != n || state.rotor_angle.size() != n) {
    throw InputError("state: this vehicle has " + std::to_string(n) +
                     " rotors; give as many velocities and angles");
  }
  if (!std::isfinite(state.time) || !state.position.allFinite() ||
      !state.orientation.coeffs().allFinite() || !state.linear_velocity.allFinite() ||
      !state.angular_velocity.allFinite() || !state.rotor_velocity.allFinite() ||
      !state.rotor_angle.allFinite()) {
    throw InputError("state: a value is not a finite number");
  }
  if (!(state.orientation.norm() > 1e-6)) {
    throw InputError("state: the orientation is no quaternion; give a unit (x, y, z, w)");
  }
  engine_->set_state(state);
  start_time_ = state.time;
  steps_ = 0;
  failure_.clear();
  show_state();
  try {
    sense(true);
  } catch (...) {
    fail(what_was_thrown());
  }
}

/// What a snapshot and the simulation that it is restored to must have in common.
std::string Simulation::describe_kind() const {
  std::ostringstream kind;
  kind.precision(17);
  kind << engine_name_ << ' ' << dt_ << ' ' << model().name;
  for (const Link& link : model().links) kind << '|' << link.name << ' ' << link.inertial.mass;
  for (const Joint& joint : model().joints) kind << '|' << joint.name;
  for (const LoadedPlugin& p : plugins_) kind << '|' << p.name << ' ' << p.path << ' ' << p.state_size;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    kind << '|' << topics_[i].name << ' ' << joined(topics_[i].fields);
  }
  return kind.str();
}

Snapshot Simulation::snapshot() const {
  return {kind_, start_time_, steps_, engine_->save(), plugin_state_, topics_, failure_};
}

void Simulation::restore(const Snapshot& snapshot) {
  if (snapshot.kind != kind_) {
    throw InputError(
        "snapshot: was taken from another engine, step or model; restore one of this simulation");
  }
  engine_->restore(snapshot.engine);
  start_time_ = snapshot.start_time;
  steps_ = snapshot.steps;
  plugin_state_ = snapshot.plugin_state;
  topics_ = snapshot.topics;
  failure_ = snapshot.failure;
  show_state();
}

}  // namespace quadcore
