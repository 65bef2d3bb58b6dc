#include "variables.hpp"

#include <cmath>
#include <utility>

#include "quadcore/log.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::fmu {
namespace {

constexpr double largest_seed = 2147483647;  // maximum of an fmi2Integer

/// Return a component of a pose.
double& component(Pose& pose, std::size_t index) {
  const auto i = static_cast<Eigen::Index>(index % 3);
  return index < 3 ? pose.xyz[i] : pose.rpy[i];
}

[[noreturn]] void refuse(const Variable& variable, const char* what) {
  throw InputError("variable " + variable.name + ": " + what);
}

}  // namespace

Settings::Settings(const FlightFile& file)
    : spawn(file.options.spawn), seed(file.options.seed), tags(file.tags) {
  for (const auto& [topic, values] : file.inputs) inputs[topic].values = values;
}

bool is_output(const Variable& variable) { return variable.kind <= Variable::wrench; }

SimulationOptions options_of(const FlightFile& file, const Settings& settings) {
  SimulationOptions options = file.options;
  options.spawn = settings.spawn;
  options.seed = settings.seed;
  for (const auto& [tag, text] : settings.tags) {
    if (text != file.tags.at(tag))
      options.parameters[tag] = text;  // otherwise the value of the model applies
  }
  return options;
}

double Outputs::at(Simulation& simulation, const Variable& variable) {
  if (variable.kind == Variable::wrench) {
    if (wrenches_.empty()) {
      for (const Wrench& wrench : simulation.wrenches()) {
        for (const Vector3d& part : {wrench.force_F, wrench.torque_F})
          wrenches_.insert(wrenches_.end(), part.data(), part.data() + 3);
      }
    }
    return wrenches_.at(variable.index);
  }
  if (variable.kind == Variable::state) {
    if (state_.empty()) append_log_row(simulation.state(), state_);
    return state_.at(variable.index);
  }
  std::vector<double> row;
  append_log_row(simulation.topics()[simulation.topics().at(variable.key)], row);
  return row.at(variable.index);
}

double number(const Settings& settings, const Variable& variable) {
  switch (variable.kind) {
    case Variable::input:
      return settings.inputs.at(variable.key).values.at(variable.index);
    case Variable::spawn: {
      Pose pose = settings.spawn;
      return component(pose, variable.index);
    }
    case Variable::seed:
      return static_cast<double>(settings.seed);
    default: {
      const std::string& value = text(settings, variable);
      if (const auto number = parse_number(value)) return *number;
      if (value == "true" || value == "false") return value == "true" ? 1 : 0;
      refuse(variable, "it is a string. Use the function for strings.");
    }
  }
}

const std::string& text(const Settings& settings, const Variable& variable) {
  const auto found = settings.tags.find(variable.key);
  if (found == settings.tags.end())
    refuse(variable, "it is a number. Use the function for its type.");
  return found->second;
}

bool set_number(Settings& settings, const Variable& variable, double value) {
  if (!std::isfinite(value))
    refuse(variable, "the value is not a finite number. Give a finite number.");
  switch (variable.kind) {
    case Variable::input: {
      Waiting& message = settings.inputs.at(variable.key);
      message.values.at(variable.index) = value;
      message.is_set = true;
      return false;
    }
    case Variable::spawn:
      return std::exchange(component(settings.spawn, variable.index), value) != value;
    case Variable::seed:
      if (!(value >= 0 && value <= largest_seed && value == std::floor(value))) {
        refuse(variable, "the seed is invalid. Give a whole number from 0 to 2147483647.");
      }
      if (static_cast<std::uint64_t>(value) == settings.seed) return false;
      settings.seed = static_cast<std::uint64_t>(value);
      return true;
    case Variable::parameter: {
      std::string& kept = settings.tags.at(variable.key);
      const bool is_flag = kept == "true" || kept == "false";
      if (!is_flag && parse_number(kept) == value) return false;
      kept.clear();
      if (is_flag) {
        kept = value != 0 ? "true" : "false";
      } else {
        append_shortest(value, kept);
      }
      return true;
    }
    default:
      refuse(variable, "it cannot be set to a number. See its type in modelDescription.xml.");
  }
}

void set_text(Settings& settings, const FlightFile& file, const Variable& variable,
              const std::string& value) {
  if (variable.kind != Variable::parameter && variable.kind != Variable::file) {
    refuse(variable, "it is a number. Use the function for its type.");
  }
  const bool within = variable.kind == Variable::file && !value.empty() && value.front() != '/';
  settings.tags.at(variable.key) = within ? file.folder + "/" + value : value;
}

}  // namespace quadcore::fmu
