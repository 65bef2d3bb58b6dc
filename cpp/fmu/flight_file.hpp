#pragma once

#include <map>
#include <string>
#include <vector>

#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::fmu {

/// A variable; its value reference is its index in FlightFile::variables.
struct Variable {
  enum Kind {
    state,      ///< `index` in a row of the log
    topic,      ///< `index` in the row of topic `key`
    wrench,     ///< `index` in the row of all wrenches
    input,      ///< `index` among the fields of topic `key`
    parameter,  ///< tag `key`
    file,       ///< tag `key` with the name of a resource file
    spawn,      ///< `index` in the pose
    seed,
  };
  /// FMI type.
  enum Type { real, integer, boolean, string };
  std::string name;  ///< name for importers
  Kind kind;
  std::string key;
  std::size_t index = 0;
  bool is_fixed = false;  ///< cannot change once the flight has begun
  Type type = real;
};

/// Content of resources/flight.yaml, which `quadcore export-fmu` writes for this library.
struct FlightFile {
  std::string guid;
  Model model;
  World world;
  SimulationOptions options;
  std::map<std::string, std::string> tags;  ///< PLUGIN.TAG -> text, for all tags that are variables
  std::vector<Variable> variables;
  std::map<std::string, std::vector<double>> inputs;  ///< topic -> initial values
  std::string folder;                                 ///< folder of the resources
};

/// Return the FMI name of a type.
const char* name_of(Variable::Type type);

/// Read the file. Throws InputError for a file that this version of `quadcore export-fmu` did not
/// write.
FlightFile read_flight_file(const std::string& resources);

}  // namespace quadcore::fmu
