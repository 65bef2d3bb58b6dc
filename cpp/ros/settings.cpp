#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::node {
namespace {

/// The private parameters of a node, each read once and strictly.
class PrivateParameters {
 public:
  std::string text(const std::string& name, const std::string& fallback) {
    XmlRpc::XmlRpcValue value;
    if (!get(name, value)) return fallback;
    if (value.getType() != XmlRpc::XmlRpcValue::TypeString) fail(name, "text");
    return static_cast<std::string>(value);
  }
  bool flag(const std::string& name, bool fallback) {
    XmlRpc::XmlRpcValue value;
    if (!get(name, value)) return fallback;
    if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean) fail(name, "true or false");
    return static_cast<bool>(value);
  }
  std::optional<double> number(const std::string& name) {
    XmlRpc::XmlRpcValue value;
    double number = 0;
    if (!get(name, value)) return std::nullopt;
    if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) {
      number = static_cast<int>(value);
    } else if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
      number = static_cast<double>(value);
    } else {
      fail(name, "a number");
    }
    if (!std::isfinite(number)) fail(name, "a finite number");
    return number;
  }
  double number(const std::string& name, double fallback) {
    return number(name).value_or(fallback);
  }
  /// \param hint  what else is to be said of the number
  std::optional<double> no_negative(const std::string& name, const std::string& hint = "") {
    const std::optional<double> value = number(name);
    if (value && *value < 0) fail(name, "a number >= 0" + hint);
    return value;
  }
  /// Throws if the server holds a parameter that nobody asked for: a misspelt one.
  void check_all_known() const {
    std::vector<std::string> names;
    nh_.getParamNames(names);
    const std::string prefix = nh_.getNamespace() + "/";
    for (const std::string& name : names) {
      if (name.compare(0, prefix.size(), prefix) != 0) continue;
      const std::string own =
          name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
      if (known_.count(own) > 0) continue;
      throw InputError("parameter ~" + own + ": is not known" +
                       did_you_mean(own, {known_.begin(), known_.end()}) +
                       "; it stays on the parameter server until you run: rosparam delete " +
                       prefix + own);
    }
  }

  [[noreturn]] static void fail(const std::string& name, const std::string& wanted) {
    throw InputError("parameter ~" + name + ": give " + wanted);
  }

 private:
  bool get(const std::string& name, XmlRpc::XmlRpcValue& value) {
    known_.insert(name);
    return nh_.getParam(name, value);
  }

  ros::NodeHandle nh_{"~"};
  std::set<std::string> known_;
};

Document described_model(const ros::NodeHandle& nh, const std::string& path) {
  if (!path.empty()) {
    if (path.size() > 6 && path.compare(path.size() - 6, 6, ".xacro") == 0) {
      throw InputError(path +
                       ": is xacro; load it expanded as robot_description, as "
                       "quadrotor.launch does");
    }
    return Document::read(path);
  }
  std::string where, text;
  if (!nh.searchParam("robot_description", where) || !nh.getParam(where, text)) {
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
  s.verbose = p.flag("verbose", false);

  s.simulation.engine = p.text("engine", s.simulation.engine);
  const double dt = p.no_negative("dt", "; 0 is that of the world").value_or(0);
  if (dt > 0) s.simulation.dt = dt;
  constexpr double greatest_seed = 9007199254740992;  // all whole numbers below are doubles
  const double seed = p.number("seed", 0);
  if (seed != std::floor(seed) || seed < 0 || seed > greatest_seed) {
    PrivateParameters::fail("seed", "a whole number from 0 to 9007199254740992");
  }
  s.simulation.seed = static_cast<std::uint64_t>(seed);
  s.simulation.spawn.xyz = {p.number("x", 0), p.number("y", 0), p.number("z", 0.1)};
  s.simulation.spawn.rpy = {p.number("roll", 0), p.number("pitch", 0), p.number("yaw", 0)};

  s.real_time_factor = p.no_negative("real_time_factor", "; 0 is as fast as possible");
  s.flight.paused = p.flag("paused", false);
  s.flight.lockstep = p.flag("lockstep", false);
  s.flight.lockstep_timeout = p.no_negative("lockstep_timeout").value_or(s.flight.lockstep_timeout);
  p.check_all_known();
  s.model = described_model(nh, model);
  return s;
}

}  // namespace quadcore::node
