#include "instance.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin_library.hpp"
#include "quadcore/text.hpp"

namespace quadcore::fmu {
namespace {

/// Tolerance of a communication step as a multiple of the time step, as a fraction of a time step.
constexpr double roundness = 1e-6;
/// Maximum number of steps of a communication step, up to which a double counts exactly.
constexpr double most_steps = 9007199254740992;

}  // namespace

Instance::Instance(const std::string& resources, const std::string& guid)
    : file_(read_flight_file(resources)), settings_(file_) {
  if (guid != file_.guid) {
    throw InputError("the GUID is " + guid + ", but this FMU has " + file_.guid +
                     ". Read modelDescription.xml again.");
  }
  // The core may belong to the same FMU in another folder, which no longer exists.
  load_plugin_path(resources + "/../binaries/linux64");
}

void Instance::start_at(double time) {
  if (!std::isfinite(time))
    throw InputError("the start time is not a finite number. Give a time in s.");
  start_time_ = time;
}

void Instance::initialise() {
  outputs_.forget();
  simulation_ = made();
  tuned_ = false;
  reported_warnings_ = 0;
  is_flying_ = false;
}

void Instance::begin() {
  if (!simulation_)
    throw InputError(
        "fmi2ExitInitializationMode was called before fmi2EnterInitializationMode. Enter the "
        "initialisation mode first.");
  tune();
  is_flying_ = true;
}

std::unique_ptr<Simulation> Instance::made() const {
  return std::make_unique<Simulation>(file_.model, file_.world, options_of(file_, settings_));
}

void Instance::tune() {
  if (!tuned_) return;
  if (!is_flying_) return initialise();
  Allowed allowed;
  allowed.parameters = true;
  std::unique_ptr<Simulation> tuned = made();
  tuned->restore(simulation_->snapshot(), allowed);
  simulation_ = std::move(tuned);
  tuned_ = false;
}

void Instance::step(double time, double length) {
  if (!is_flying_)
    throw InputError(
        "fmi2DoStep was called before the end of the initialisation. Call "
        "fmi2ExitInitializationMode first.");
  const double dt = simulation_->dt();
  const double count = std::round(length / dt);
  const bool is_counted = count >= 1 && count <= most_steps;
  if (!is_counted || std::abs(length - count * dt) > roundness * dt) {
    std::string text = "the communication step is ";
    append_shortest(length, text);
    text += " s. Use a whole multiple of the time step of ";
    append_shortest(dt, text);
    throw InputError(text + " s" + (count > most_steps ? ", at most 2^53 of them." : "."));
  }
  if (!(std::abs(time - this->time()) < dt / 2)) {
    throw InputError("the step starts at " + seconds(time) + ", but the flight is at " +
                     seconds(this->time()) + ". Continue from there.");
  }
  outputs_.forget();
  tune();
  for (auto& [topic, message] : settings_.inputs) {
    if (std::exchange(message.is_set, false) && is_said(topic, message)) {
      simulation_->publish(topic, message.values.data(), message.values.size());
    }
  }
  simulation_->step(static_cast<std::int64_t>(count));
}

bool Instance::is_said(const std::string& name, const Waiting& message) const {
  const Topics& topics = simulation_->topics();
  const Topic& topic = topics[topics.at(name)];
  return flown_time() > 0 || topic.count > 0 || message.values != topic.values ||
         name == Simulation::command_topic;
}

void Instance::reset() {
  simulation_.reset();
  settings_ = Settings(file_);
  start_time_ = 0;
  is_flying_ = tuned_ = false;
  reported_warnings_ = 0;
}

double Instance::time() const { return start_time_ + (simulation_ ? flown_time() : 0); }

double Instance::flown_time() const {
  return simulation_->time() - simulation_->world().start_time;
}

const Variable& Instance::variable(unsigned reference, Variable::Type type) const {
  if (reference >= file_.variables.size()) {
    throw InputError("no variable has the value reference " + std::to_string(reference) +
                     ". Use one of modelDescription.xml.");
  }
  const Variable& v = file_.variables[reference];
  if (v.type == type) return v;
  throw InputError("variable " + v.name + ": its type is " + name_of(v.type) + ", not " +
                   name_of(type) + ". Call the function for its type.");
}

const Variable& Instance::settable(unsigned reference, Variable::Type type) const {
  const Variable& v = variable(reference, type);
  if (!is_flying_ || !v.is_fixed) return v;
  throw InputError("variable " + v.name +
                   ": it cannot change after the initialisation. Set it before, or reset the FMU.");
}

double Instance::number(unsigned reference, Variable::Type type) {
  const Variable& v = variable(reference, type);
  if (!is_output(v)) return fmu::number(settings_, v);
  if (!simulation_)
    throw InputError(
        "an output was requested before the initialisation. Initialise the FMU first.");
  if (!is_flying_) tune();
  return outputs_.at(*simulation_, v);
}

const std::string& Instance::text(unsigned reference) {
  return fmu::text(settings_, variable(reference, Variable::string));
}

void Instance::set_number(unsigned reference, Variable::Type type, double value) {
  if (fmu::set_number(settings_, settable(reference, type), value)) tuned_ = true;
}

void Instance::set_text(unsigned reference, const char* value) {
  const Variable& v = settable(reference, Variable::string);
  if (!value)
    throw InputError("variable " + v.name + ": the value is a null pointer. Give a text.");
  fmu::set_text(settings_, file_, v, value);
  tuned_ = true;
}

SavedState Instance::save() {
  if (simulation_ && !is_flying_) tune();
  SavedState state{file_.guid, settings_, start_time_, nullptr, is_flying_};
  if (simulation_) state.snapshot = std::make_shared<Snapshot>(simulation_->snapshot());
  return state;
}

void Instance::restore(const SavedState& state) {
  Settings before = std::exchange(settings_, state.settings);
  try {
    std::unique_ptr<Simulation> other;
    if (state.snapshot) {
      // Parameters that were set after the last step are not yet in the simulation.
      const bool same = simulation_ && !tuned_ && before.tags == state.settings.tags;
      if (!same) other = made();
      Allowed allowed;
      allowed.parameters = true;
      (same ? *simulation_ : *other).restore(*state.snapshot, allowed);
      if (same) other = std::move(simulation_);
    }
    simulation_ = std::move(other);
  } catch (...) {
    settings_ = std::move(before);
    throw;
  }
  outputs_.forget();
  start_time_ = state.start_time;
  is_flying_ = state.is_flying;
  tuned_ = false;
  reported_warnings_ = simulation_ ? simulation_->warnings().size() : 0;
}

std::vector<std::string> Instance::take_warnings() {
  if (!simulation_) return {};
  const std::vector<std::string>& all = simulation_->warnings();
  const std::size_t first = std::min(std::exchange(reported_warnings_, all.size()), all.size());
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.end()};
}

}  // namespace quadcore::fmu
