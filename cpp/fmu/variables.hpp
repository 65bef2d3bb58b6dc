#pragma once

#include <map>
#include <string>
#include <vector>

#include "flight_file.hpp"

namespace quadcore::fmu {

/// A message for the next step.
struct Waiting {
  std::vector<double> values;
  bool is_set = false;  ///< whether it was set since the last step
};

/// Values that the importer can set: everything in addition to the flight file and the snapshot.
struct Settings {
  Pose spawn;
  std::uint64_t seed;
  std::map<std::string, std::string> tags;  ///< see FlightFile
  std::map<std::string, Waiting> inputs;    ///< messages by topic

  explicit Settings(const FlightFile& file);
};

/// Values of a simulation in its present state; rows of many variables are computed once.
class Outputs {
 public:
  /// Discard the rows because the state has changed.
  void forget() {
    state_.clear();
    wrenches_.clear();
  }
  double at(Simulation& simulation, const Variable& variable);

 private:
  std::vector<double> state_, wrenches_;
};

/// \name Values that can be set
/// They throw InputError if the variable has another type or cannot have the value.
/// @{
double number(const Settings& settings, const Variable& variable);
const std::string& text(const Settings& settings, const Variable& variable);
/// \returns whether a parameter has changed
bool set_number(Settings& settings, const Variable& variable, double value);
void set_text(Settings& settings, const FlightFile& file, const Variable& variable,
              const std::string& value);
/// @}

bool is_output(const Variable& variable);
/// Return the options of a simulation with the settings.
SimulationOptions options_of(const FlightFile& file, const Settings& settings);

}  // namespace quadcore::fmu
