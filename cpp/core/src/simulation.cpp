#include "quadcore/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr const char* command_topic_name = "vel_cmd";
/// Beyond these no flight is meant; the numbers only say "diverged" before they overflow.
constexpr double max_speed = 1e6;     // m/s
constexpr double max_distance = 1e9;  // m
constexpr double max_time = 1e9;      // s; far beyond, a step no longer moves the clock
constexpr const char* no_longer_finite = "the state is no longer finite";

/// Not std::to_string, which writes a decimal comma in some locales.
std::string seconds(double time) {
  std::ostringstream text;
  text << std::fixed << time << " s";
  return text.str();
}

bool is_finite(const Kinematics& k) {
  double rates = 0;
  for (std::size_t i = 0; i < k.rotors.size(); ++i) rates += k.rotors[i].rate;
  return k.p_WF.allFinite() && k.q_WF.coeffs().allFinite() && k.v_WF_F.allFinite() &&
         k.w_WF_F.allFinite() && std::isfinite(rates);
}

}  // namespace

Simulation::Simulation(Model model, const World& world, const SimulationOptions& options)
    : engine_name_(options.engine),
      dt_(options.dt.value_or(world.max_step_size)),
      warnings_(model.warnings),
      wrench_loads_(model.joints.size()) {
  if (!(dt_ >= shortest_step && std::isfinite(dt_))) {
    std::ostringstream what;
    what << "dt is " << dt_ << "; write a step in s, from " << shortest_step << " up";
    throw InputError(what.str());
  }
  if (!options.spawn.xyz.allFinite() || !options.spawn.rpy.allFinite()) {
    throw InputError("spawn holds a number that is not finite; write x,y,z[,roll,pitch,yaw]");
  }
  load_plugins(model, options);
  warn(world.passed_over.warning());
  ignored_ = ignored_in({&model.passed_over, &world.passed_over});
  engine_ = make_engine(options.engine, model, world);
  for (const std::string& warning : engine_->warnings()) warn(warning);
  warnings_at_load_ = warnings_.size();
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

void Simulation::warn(const std::string& warning) {
  if (!warning.empty()) warnings_.push_back(warning);
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
  topics_.publish(topic, time());
  std::copy(speeds, speeds + count, topics_.values(topic).begin());
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
  if (!is_finite(kinematics)) throw Error(no_longer_finite + advice());
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
  const Sample sample{time(), dt_, engine_->kinematics(), topics_, said_, jumped};
  for (const LoadedPlugin& p : plugins_) {
    enter(p);
    p.plugin->sense(sample, state_of(p));
    if (!said_.empty()) collect_warnings();
  }
  leave();
}

void Simulation::update() {
  const Sample sample{time(), dt_, engine_->kinematics(), topics_, said_};
  for (const LoadedPlugin& p : plugins_) {
    enter(p);
    p.plugin->update(sample, state_of(p));
    if (!said_.empty()) collect_warnings();
  }
  leave();
}

void Simulation::collect_warnings() {
  for (const std::string& what : said_) {
    warnings_.push_back("t = " + seconds(time()) + ": plugin '" + active_->name + "': " + what);
  }
  said_.clear();
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
  if (!said_.empty()) collect_warnings();
  failure_ = "the flight failed at t = " + seconds(time()) + ": ";
  if (active_) failure_ += "plugin '" + active_->name + "' (" + active_->path + "): ";
  failure_ += what;
  leave();
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
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    sane = sane && std::abs(k.rotors[i].rate) < max_rate;
  }
  if (sane) return;
  throw Error((is_finite(k) ? "the motion diverged" : no_longer_finite) + advice());
}

std::string Simulation::advice() const {
  if (warnings_.size() == warnings_at_load_) return "; try a smaller step or weaker commands";
  return ", as this flight was warned: " + warnings_.back();
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
  if (std::abs(state.time) > max_time) {
    throw InputError("state: the time is beyond 1e9 s; give the seconds since the flight began");
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
  } catch (const InputError&) {  // two writers of one topic
    leave();
    throw;
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
  return {kind_,
          start_time_,
          steps_,
          engine_->save(),
          plugin_state_,
          topics_,
          {of_flight, warnings_.end()},
          failure_};
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
  warnings_.resize(warnings_at_load_);
  warnings_.insert(warnings_.end(), snapshot.warnings.begin(), snapshot.warnings.end());
  failure_ = snapshot.failure;
  show_state();
}

}  // namespace quadcore
