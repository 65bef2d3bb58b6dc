#include "plant.hpp"

#include <filesystem>
#include <system_error>

#include "drag_choice.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr double max_step = 0.1;  ///< s; no controller of a multirotor works with a longer step

/// Returns the path of a world, or of the built-in world of this name.
std::string find_world(const std::string& world, const std::string& built_in_worlds,
                       const std::string& folder) {
  const std::string built_in = built_in_worlds + "/" + world + ".world";
  const bool is_name = world.find_first_of("/.") == std::string::npos;
  std::error_code ignored;
  return is_name && std::filesystem::is_regular_file(built_in, ignored)
             ? built_in
             : resolve_path(folder, world);
}

/// Parses "PLUGIN.TAG=VALUE" ... like the command line.
std::map<std::string, std::string> parse_assignments(const std::string& parameter,
                                                     const std::vector<std::string>& words) {
  std::map<std::string, std::string> values;
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    const auto dot = word.rfind('.', equals);
    if (equals == std::string::npos || equals + 1 == word.size() || dot == std::string::npos ||
        dot == 0 || dot + 1 == equals) {
      throw InputError("parameter ~" + parameter + ": '" + word +
                       "' is not valid. Write PLUGIN.TAG=VALUE.");
    }
    if (!values.emplace(word.substr(0, equals), word.substr(equals + 1)).second) {
      throw InputError("parameter ~" + parameter + ": " + word.substr(0, equals) +
                       " is given twice. Keep one.");
    }
  }
  return values;
}

}  // namespace

// roslaunch starts nodes in another folder. The launch file passes its own folder with `pwd`,
// including a newline.
std::string resolve_path(std::string folder, const std::string& path) {
  while (!folder.empty() && folder.back() == '\n') folder.pop_back();
  return folder.empty() || path.empty() || path.front() == '/' ? path : folder + "/" + path;
}

Plant read_plant(PrivateParameters& p) {
  Plant plant;
  plant.model_path = p.text("model", "");
  plant.folder = p.text("folder", "");
  const std::string built_in_worlds = p.text("shipped_worlds", "worlds");
  plant.world = find_world(p.text("world", ""), built_in_worlds, plant.folder);
  plant.name = p.text("name", "");
  plant.frames = {p.text("map_frame", ""), p.text("world_frame", ""), p.text("vehicle_frame", "")};
  plant.drag = p.text("drag", "all");
  plant.ignore = p.words("ignore");

  SimulationOptions& s = plant.simulation;
  s.parameters = parse_assignments("set", p.words("set"));
  s.engine = p.text("engine", s.engine);
  const double dt = p.number("dt", 0);
  if (dt != 0 && !(dt >= shortest_step && dt <= max_step)) {
    refuse_parameter("dt", "a step from 1e-9 to 0.1 s, or 0 for the step of the world");
  }
  if (dt > 0) s.dt = dt;
  constexpr double max_seed = 9007199254740992;  // all smaller whole numbers are exact as doubles
  s.seed = static_cast<std::uint64_t>(p.whole("seed", 0, 0, max_seed));
  s.spawn.xyz = {p.number("x", 0), p.number("y", 0), p.number("z", 0.1)};
  s.spawn.rpy = {p.number("roll", 0), p.number("pitch", 0), p.number("yaw", 0)};
  return plant;
}

void read_description(const ros::NodeHandle& nh, Plant& plant) {
  const std::string& path = plant.model_path;
  if (!path.empty()) {
    if (path.size() > 6 && path.compare(path.size() - 6, 6, ".xacro") == 0) {
      throw InputError(path +
                       ": is a xacro file. Load its expansion as robot_description, as "
                       "quadrotor.launch does.");
    }
    plant.model = Document::read(path);
    return;
  }
  std::string text;
  if (!nh.searchParam("robot_description", plant.description) ||
      !nh.getParam(plant.description, text)) {
    throw InputError(
        "robot_description: is not on the parameter server. Start with roslaunch quadcore "
        "quadrotor.launch, or set ~model to a URDF file.");
  }
  plant.model = {"robot_description", text};
}

// Like gazebo_ros' empty world, with a ground plane.
World read_world_of(const Plant& plant) {
  if (!plant.world.empty()) return read_world(Document::read(plant.world), plant.ignore);
  World world;
  world.ground_plane = true;
  return world;
}

Simulation make_simulation(const Plant& plant, World world, const Guests& guests) {
  Model model = read_model(plant.model, plant.ignore);
  check_ignored(plant.ignore, {&model.ignored_elements, &world.ignored_elements});
  SimulationOptions options = plant.simulation;
  choose_drag(plant.drag, model, options.parameters);
  for (const PluginElement& guest : guests(model, world)) model.plugins.push_back(guest);
  return {std::move(model), world, options};
}

std::string choose_model_name(const Plant& plant, const Model& model) {
  const std::string& name = plant.name.empty() ? model.name : plant.name;
  std::string why;
  if (!ros::names::validate(name, why)) {
    throw InputError("model name '" + name + "' cannot name a topic (" + why + "). Set ~name.");
  }
  return name;
}

std::string resolve_command_topic(const ros::NodeHandle& nh, const Plant& plant,
                                  const Model& model) {
  return nh.resolveName(choose_model_name(plant, model) + "/" + Simulation::command_topic);
}

}  // namespace quadcore::node
