#include <algorithm>
#include <cmath>

#include "quadcore/commands.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

/// \file
/// Publishing by the simulation's caller.

namespace quadcore {

bool Simulation::takes_commands() const {
  return command_topic_ >= 0 &&
         topics_[static_cast<std::size_t>(command_topic_)].writer == the_caller;
}

std::size_t Simulation::command_width() const {
  if (command_topic_ < 0) {
    throw InputError("no plugin of model '" + model().name +
                     "' accepts commands. Add libmotorpid_plugin.so.");
  }
  return topics_[static_cast<std::size_t>(command_topic_)].values.size();
}

void Simulation::command(const double* speeds, std::size_t count) {
  check_command(speeds, count, command_width());
  publish("command()", static_cast<std::size_t>(command_topic_), speeds);
}

void Simulation::publish(const std::string& name, const double* values, std::size_t count) {
  const std::size_t index = topics_.at(name);
  const std::vector<std::string>& fields = topics_[index].kind.fields;
  const std::string what = "publish: topic '" + name + "': ";
  if (count != fields.size()) {
    throw InputError(what + std::to_string(count) + " numbers are given. Give " +
                     std::to_string(fields.size()) + ": " + joined(fields) + ".");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(values[i]))
      throw InputError(what + fields[i] + " is not a finite number. Give a finite number.");
  }
  publish("publish()", index, values);
}

void Simulation::publish(const char* call, std::size_t index, const double* values) {
  if (topics_[index].writer != the_caller) topics_.refuse_second(call, topics_[index]);
  std::copy_n(values, topics_[index].values.size(), topics_.publish(index, time()));
}

}  // namespace quadcore
