#include "quadcore/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "flight_checks.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {

Simulation::Simulation(Model model, const World& world, const SimulationOptions& options)
    : engine_name_(options.engine),
      model_(std::move(model)),
      world_(world),
      dt_(options.dt.value_or(world.max_step_size)),
      warnings_(model_.warnings),
      wrench_loads_(model_.joints.size()) {
  if (!(dt_ >= shortest_step && std::isfinite(dt_))) {
    std::ostringstream what;
    what << "dt is " << dt_ << " s. Use a step of at least " << shortest_step << " s.";
    throw InputError(what.str());
  }
  check_spawn(options.spawn);
  load_plugins(model_, options);
  note_hooks();
  warn(world.ignored_elements.warning());
  warn(world.ignored_elements.unsimulated_warning());
  if (!world.ignored_models.empty()) {
    warn("the vehicle passes through " + joined(world.ignored_models) +
         ", because these models of the world are ignored on request. Remove --ignore to keep "
         "them.");
  }
  ignored_ = ignored_in({&model_.ignored_elements, &world.ignored_elements});
  const std::vector<std::string> unsimulated = world.ignored_elements.unsimulated();
  ignored_.insert(ignored_.end(), unsimulated.begin(), unsimulated.end());
  engine_ = create_engine(model_);
  for (const std::string& warning : engine_->warnings()) warn(warning);
  warnings_at_load_ = warnings_.size();
  command_topic_ = topics_.find(command_topic);
  fingerprint_ =
      std::make_shared<Fingerprint>(engine_name_, dt_, model_, world_, plugins_, topics_);

  const auto n = static_cast<Eigen::Index>(model_.joints.size());
  state_.rotor_velocity = VectorXd::Zero(n);
  state_.rotor_angle = VectorXd::Zero(n);
  start_ = state_;
  start_.position = options.spawn.xyz;
  start_.orientation = options.spawn.rotation();
  start_.time = world.start_time;
  try {
    check_drivers();
    take_along();
    prepare_plugins();
    gather_laws();
  } catch (...) {
    throw InputError(blamed());
  }
  place(start_);
  initial_ = snapshot();
  reset(options.seed);
}

void Simulation::warn(const std::string& warning) {
  if (!warning.empty()) warnings_.push_back(warning);
}

void Simulation::step(std::int64_t n, TotalVariation* rates) {
  if (n < 0)
    throw InputError("the step count is " + std::to_string(n) + ". Give a whole number >= 0.");
  if (rates && rates->sums().size() != model().joints.size()) {
    throw InputError("the sums of joint rates are " + std::to_string(rates->sums().size()) +
                     ". Give one for each joint.");
  }
  check_usable();
  try {
    for (; n > 0; --n) {
      begin_step();
      if (motion_) {
        move();
      } else {
        engine_->step(time(), dt_, *this);
      }
      end_step();
      if (rates) rates->add_row(engine_->kinematics().rotors, MotionRow::rate);
    }
    is_outdated_ = has_old_angles_ = true;
  } catch (...) {
    fail(what_was_thrown());
  }
}

void Simulation::check_usable() const {
  if (failure_.empty()) return;
  throw FlightError(time(), failure_ + (failure_.back() == '.' ? "" : ".") +
                                " To continue, call reset, restore or set_state.");
}

void Simulation::begin_step() {
  if (!are_quiet()) update();
  if (!with_.carried.empty()) take_along();
}

void Simulation::end_step() {
  ++steps_;
  check_flight();
  show_instant();
  sense(false);
}

void Simulation::move_by(Motion motion) { motion_ = std::move(motion); }

void Simulation::move() {
  show_state();
  const Topic& topic = topics_[topics_.at(command_topic)];
  const VectorXd command = Eigen::Map<const VectorXd>(
      topic.values.data(), static_cast<Eigen::Index>(topic.values.size()));
  VehicleState moved = state_;  // motion_ writes into its arrays in place
  motion_(dt_, command, moved);
  engine_->set_state(moved);
}

std::string Simulation::blamed() const {
  return (active_ ? active_->who + " (" + active_->path + "): " : "") + what_was_thrown();
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

void Simulation::show_motion() const {
  engine_->get_motion(state_);
  state_.time = time();
  is_outdated_ = false;
}

void Simulation::show_state() const {
  engine_->get_state(state_);
  state_.time = time();
  is_outdated_ = has_old_angles_ = false;
}

void Simulation::check_flight() const {
  const Kinematics& k = engine_->kinematics();
  if (is_sane(k)) return;
  throw Error((is_finite(k) ? "the motion diverged" : no_longer_finite) + advice());
}

std::string Simulation::advice() const {
  if (warnings_.size() == warnings_at_load_) return ". Try a smaller step or weaker commands.";
  return ". This warning came before: " + warnings_.back();
}

void Simulation::set_state(const VehicleState& state) {
  check_state(state, state_.rotor_velocity.size());
  place(state);
  begin();
}

void Simulation::place(const VehicleState& state) {
  engine_->set_state(state);
  start_time_ = state.time;
  steps_ = 0;
  failure_.clear();
  show_state();
}

void Simulation::begin() {
  try {
    show_instant();
    sense(true);
  } catch (const InputError&) {  // the input is rejected; no flight has failed
    leave();
    throw;
  } catch (...) {
    fail(what_was_thrown());
  }
}

}  // namespace quadcore
