#pragma once

#include <map>
#include <string>
#include <vector>

#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::fmu {

/// What a variable is; its value reference is its place in FlightFile::variables.
struct Variable {
  enum Kind {
    state,      ///< `index` in a row of the log
    topic,      ///< `index` in the row of topic `key`
    wrench,     ///< `index` in the row of all wrenches
    input,      ///< `index` among the fields of topic `key`
    parameter,  ///< tag `key`
    file,       ///< tag `key`, which names a file among the resources
    spawn,      ///< `index` in the pose
    seed,
  };
  /// FMI's.
  enum Type { real, integer, boolean, string };
  std::string name;  ///< for importers
  Kind kind;
  std::string key;
  std::size_t index = 0;
  bool is_fixed = false;  ///< when the flight has begun
  Type type = real;
};

/// What `quadcore export-fmu` writes for this library: resources/flight.yaml.
struct FlightFile {
  std::string guid;
  Model model;
  World world;
  SimulationOptions options;
  std::map<std::string, std::string> tags;  ///< PLUGIN.TAG -> text, of all that are variables
  std::vector<Variable> variables;
  std::map<std::string, std::vector<double>> inputs;  ///< topic -> what it holds at first
  std::string folder;                                 ///< of the resources
};

/// FMI's name of a type.
const char* name_of(Variable::Type type);

/// Throws InputError on a file that `quadcore export-fmu` of this version did not write.
FlightFile read_flight_file(const std::string& resources);

}  // namespace quadcore::fmu
