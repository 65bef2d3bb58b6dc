#include "flight_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>

#include "quadcore/plugin/error.hpp"

namespace quadcore::fmu {
namespace {

constexpr int version = 2;

/// Names in the order of Variable::Kind.
constexpr std::array<const char*, 8> kinds = {"state",     "topic", "wrench", "input",
                                              "parameter", "file",  "spawn",  "seed"};

/// Names in the order of Variable::Type.
constexpr std::array<const char*, 4> types = {"Real", "Integer", "Boolean", "String"};

/// Return the index of a name.
template <class Enum, std::size_t n>
Enum place(const std::string& name, const std::array<const char*, n>& names) {
  const auto* const found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw InputError("unknown kind or type of variable '" + name + "'");
  return static_cast<Enum>(found - names.begin());
}

Document document_of(const YAML::Node& node) {
  Document document{node["name"].as<std::string>(), node["text"].as<std::string>()};
  const auto files = node["files"].as<std::vector<std::string>>();
  for (const auto& place : node["lines"].as<std::vector<std::pair<std::size_t, int>>>()) {
    document.lines.emplace_back(files.at(place.first), place.second);
  }
  return document;
}

FlightFile read(const std::string& folder) {
  const YAML::Node root = YAML::LoadFile(folder + "/flight.yaml");
  if (root["version"].as<int>() != version)
    throw InputError("its version differs from this library's");
  FlightFile file;
  file.folder = folder;
  file.guid = root["guid"].as<std::string>();
  using Names = std::vector<std::string>;
  const YAML::Node model = root["model"], world = root["world"];
  file.model = read_model(document_of(model), model["ignore"].as<Names>());
  file.world = read_world(document_of(world), world["ignore"].as<Names>());
  file.options.engine = root["engine"].as<std::string>();
  file.options.dt = root["dt"].as<double>();
  file.options.seed = root["seed"].as<std::uint64_t>();
  using Texts = std::map<std::string, std::string>;
  file.options.parameters = root["parameters"].as<Texts>();
  file.tags = root["tags"].as<Texts>();
  for (const auto& [tag, name] : root["files"].as<Texts>()) {
    file.options.parameters[tag] = file.tags[tag] = folder + "/" + name;
  }
  file.inputs = root["inputs"].as<std::map<std::string, std::vector<double>>>();
  const auto spawn = root["spawn"].as<std::vector<double>>();
  std::copy_n(spawn.begin(), 3, file.options.spawn.xyz.data());
  std::copy_n(spawn.begin() + 3, 3, file.options.spawn.rpy.data());
  for (const YAML::Node& v : root["variables"]) {
    file.variables.push_back(
        {v[0].as<std::string>(), place<Variable::Kind>(v[1].as<std::string>(), kinds),
         v[2].as<std::string>(), v[3].as<std::size_t>(), v[4].as<std::string>() == "fixed",
         place<Variable::Type>(v[5].as<std::string>(), types)});
  }
  return file;
}

}  // namespace

const char* name_of(Variable::Type type) { return types.at(type); }

FlightFile read_flight_file(const std::string& resources) {
  try {
    return read(resources);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(resources + "/flight.yaml: " + error.what() + ". Export the FMU again.");
  }
}

}  // namespace quadcore::fmu
