#pragma once

#include <map>
#include <string>
#include <vector>

#include "flight_file.hpp"

namespace quadcore::fmu {

/// A message that waits for the next step.
struct Waiting {
  std::vector<double> values;
  bool is_set = false;  ///< since the last step
};

/// What can be set from outside: all that a flight has beside its file and its snapshot.
struct Settings {
  Pose spawn;
  std::uint64_t seed;
  std::map<std::string, std::string> tags;  ///< see FlightFile
  std::map<std::string, Waiting> inputs;    ///< by topic

  explicit Settings(const FlightFile& file);
};

/// What is read of a simulation in its present state; rows of many variables are made once.
class Outputs {
 public:
  /// The state has changed.
  void forget() {
    state_.clear();
    wrenches_.clear();
  }
  double at(Simulation& simulation, const Variable& variable);

 private:
  std::vector<double> state_, wrenches_;
};

/// \name Values of what can be set
/// Throw InputError if the variable is no such one, or cannot have the value.
/// @{
double number(const Settings& settings, const Variable& variable);
const std::string& text(const Settings& settings, const Variable& variable);
/// Returns whether a parameter has changed.
bool set_number(Settings& settings, const Variable& variable, double value);
void set_text(Settings& settings, const FlightFile& file, const Variable& variable,
              const std::string& value);
/// @}

bool is_output(const Variable& variable);
/// Those of a simulation with the settings.
SimulationOptions options_of(const FlightFile& file, const Settings& settings);

}  // namespace quadcore::fmu
