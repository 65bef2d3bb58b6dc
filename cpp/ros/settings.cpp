#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
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
  double number(const std::string& name, double fallback) {
    XmlRpc::XmlRpcValue value;
    double number = fallback;
    if (!get(name, value)) return fallback;
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
  double number_at_least(double least, const std::string& name, double fallback) {
    const double value = number(name, fallback);
    if (value < least) fail(name, "a number >= " + std::to_string(least));
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
                       did_you_mean(own, {known_.begin(), known_.end()}));
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

/// A path, or the name of a world in `folder`.
std::string world_path(const std::string& world, const std::string& folder) {
  const std::string shipped = folder + "/" + world + ".world";
  const bool is_name = world.find_first_of("/.") == std::string::npos;
  return is_name && std::ifstream(shipped) ? shipped : world;
}

}  // namespace

Settings read_settings(const ros::NodeHandle& nh) {
  PrivateParameters p;
  Settings s;
  const std::string model = p.text("model", "");
  const std::string shipped_worlds = p.text("shipped_worlds", "worlds");
  s.world = world_path(p.text("world", ""), shipped_worlds);
  s.name = p.text("name", "");
  s.log = p.text("log", "");
  s.verbose = p.flag("verbose", false);

  s.simulation.engine = p.text("engine", s.simulation.engine);
  const double dt = p.number_at_least(0, "dt", 0);
  if (dt > 0) s.simulation.dt = dt;
  const double seed = p.number_at_least(0, "seed", 0);
  if (seed != std::floor(seed)) PrivateParameters::fail("seed", "a whole number");
  s.simulation.seed = static_cast<std::uint64_t>(seed);
  s.simulation.spawn.xyz = {p.number("x", 0), p.number("y", 0), p.number("z", 0.1)};
  s.simulation.spawn.rpy = {p.number("roll", 0), p.number("pitch", 0), p.number("yaw", 0)};

  constexpr double not_given = -1;
  const double factor = p.number("real_time_factor", not_given);
  if (factor >= 0) {
    s.real_time_factor = factor;
  } else if (factor != not_given) {
    PrivateParameters::fail("real_time_factor", "a number >= 0; 0 is as fast as possible");
  }
  s.flight.paused = p.flag("paused", false);
  s.flight.lockstep = p.flag("lockstep", false);
  s.flight.lockstep_timeout = p.number_at_least(0, "lockstep_timeout", s.flight.lockstep_timeout);
  p.check_all_known();
  s.model = described_model(nh, model);
  return s;
}

}  // namespace quadcore::node
