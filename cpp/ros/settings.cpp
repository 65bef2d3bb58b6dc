#include "settings.hpp"

#include <cmath>
#include <fstream>

#include "private_parameters.hpp"
#include "quadcore/error.hpp"

namespace quadcore::node {
namespace {

/// The model of a file, or of robot_description; `key` becomes the parameter's name, or "".
Document described_model(const ros::NodeHandle& nh, const std::string& path, std::string& key) {
  if (!path.empty()) {
    if (path.size() > 6 && path.compare(path.size() - 6, 6, ".xacro") == 0) {
      throw InputError(path +
                       ": is xacro; load it expanded as robot_description, as "
                       "quadrotor.launch does");
    }
    return Document::read(path);
  }
  std::string text;
  if (!nh.searchParam("robot_description", key) || !nh.getParam(key, text)) {
    throw InputError(
        "robot_description: is not on the parameter server; start with roslaunch quadcore "
        "quadrotor.launch, or set ~model to a URDF file");
  }
  return {"robot_description", text};
}

/// A path that, if relative, is meant from `folder`. roslaunch starts nodes in a folder of its own,
/// and the launch file tells with `pwd`, newline and all, where it was started itself.
std::string path_from(std::string folder, const std::string& path) {
  while (!folder.empty() && folder.back() == '\n') folder.pop_back();
  return folder.empty() || path.empty() || path.front() == '/' ? path : folder + "/" + path;
}

/// The path of a world, or of the one of this name among the shipped ones.
std::string world_path(const std::string& world, const std::string& shipped_worlds,
                       const std::string& folder) {
  const std::string shipped = shipped_worlds + "/" + world + ".world";
  const bool is_name = world.find_first_of("/.") == std::string::npos;
  return is_name && std::ifstream(shipped) ? shipped : path_from(folder, world);
}

/// "PLUGIN.TAG=VALUE" ... as the command line takes it.
std::map<std::string, std::string> assignments(const std::string& parameter,
                                               const std::vector<std::string>& words) {
  std::map<std::string, std::string> values;
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    const auto dot = word.rfind('.', equals);
    if (equals == std::string::npos || equals + 1 == word.size() || dot == std::string::npos ||
        dot == 0 || dot + 1 == equals) {
      throw InputError("parameter ~" + parameter + ": '" + word +
                       "' is not of the form PLUGIN.TAG=VALUE");
    }
    if (!values.emplace(word.substr(0, equals), word.substr(equals + 1)).second) {
      throw InputError("parameter ~" + parameter + ": " + word.substr(0, equals) +
                       " is given twice; keep one");
    }
  }
  return values;
}

ClockRole clock_role(const std::string& text) {
  if (text == "auto") return ClockRole::automatic;
  if (text == "lead") return ClockRole::lead;
  if (text == "follow") return ClockRole::follow;
  refuse_parameter("clock", "auto, lead or follow");
}

}  // namespace

Settings read_settings(const ros::NodeHandle& nh) {
  PrivateParameters p;
  Settings s;
  const std::string model = p.text("model", "");
  const std::string folder = p.text("folder", "");
  const std::string shipped_worlds = p.text("shipped_worlds", "worlds");
  s.world = world_path(p.text("world", ""), shipped_worlds, folder);
  s.name = p.text("name", "");
  s.log = path_from(folder, p.text("log", ""));
  s.log_topics = p.words("log_topics");
  if (s.log.empty() && !s.log_topics.empty()) {
    throw InputError("parameter ~log_topics: names topics, but there is no log; set ~log");
  }
  s.verbose = p.flag("verbose", false);
  s.rotor_tf = p.flag("rotor_tf", false);
  s.ignore = p.words("ignore");

  s.drag = p.text("drag", "all");
  s.clock = clock_role(p.text("clock", "auto"));

  s.simulation.parameters = assignments("set", p.words("set"));
  s.simulation.engine = p.text("engine", s.simulation.engine);
  const double dt = p.no_negative("dt", "; 0 is that of the world").value_or(0);
  if (dt > 0) s.simulation.dt = dt;
  constexpr double greatest_seed = 9007199254740992;  // all whole numbers below are doubles
  const double seed = p.number("seed", 0);
  if (seed != std::floor(seed) || seed < 0 || seed > greatest_seed) {
    refuse_parameter("seed", "a whole number from 0 to 9007199254740992");
  }
  s.simulation.seed = static_cast<std::uint64_t>(seed);
  s.simulation.spawn.xyz = {p.number("x", 0), p.number("y", 0), p.number("z", 0.1)};
  s.simulation.spawn.rpy = {p.number("roll", 0), p.number("pitch", 0), p.number("yaw", 0)};

  s.real_time_factor = p.no_negative("real_time_factor", "; 0 is as fast as possible");
  s.flight.paused = p.flag("paused", false);
  s.flight.lockstep = p.flag("lockstep", false);
  s.flight.lockstep_timeout = p.no_negative("lockstep_timeout").value_or(s.flight.lockstep_timeout);
  p.check_all_known();
  s.model = described_model(nh, model, s.description);
  return s;
}

}  // namespace quadcore::node
