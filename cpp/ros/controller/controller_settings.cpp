#include "controller_settings.hpp"

#include <utility>

#include "odometry_topic.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr const char* reference_file = "libreference_plugin.so";
constexpr const char* reference_topic = "reference";

std::vector<PluginTag> reference_tags_of(PrivateParameters& own) {
  own.know("reference");
  PrivateParameters below("~reference");
  if (below.any()) {
    std::vector<PluginTag> tags = below.tags(control::reference_tags());
    below.check_all_known();
    return tags;
  }
  const std::string shape = own.text("reference", "");
  if (shape.empty()) return {};
  return {{"shape", shape, "parameter ~reference"}};
}

const LoadedPlugin* writer_of(const Simulation& simulation, const std::string& topic) {
  const int index = simulation.topics().find(topic);
  if (index < 0) return nullptr;
  const int writer = simulation.topics()[static_cast<std::size_t>(index)].writer;
  return writer == the_caller ? nullptr : &simulation.plugins()[static_cast<std::size_t>(writer)];
}

/// Calls per second: a law cannot be called more often than it is told something.
double rate_of(const control::Gains& gains, const Parameters& parameters, const Simulation& plant) {
  const LoadedPlugin* const odometry = writer_of(plant, OdometryTopic::name);
  if (!odometry) {
    throw InputError(
        "no plugin of the model publishes odometry on topic odom; add "
        "libodometry_plugin.so");
  }
  for (const Parameter& parameter : odometry->parameters.all()) {
    if (parameter.spec.name != "rate") continue;
    const double sent = odometry->parameters.number("rate");
    if (sent >= gains.rate || sent * plant.dt() >= 1) break;
    if (parameters.has("rate") || parameters.has("gains")) {
      throw InputError("parameter ~rate: odometry comes " + parameter.text +
                       " times a second; give that at most, or let plugin '" + odometry->name +
                       "' send more");
    }
    ROS_INFO("the law is called as often as odometry comes, %g times a second", sent);
    return sent;
  }
  return gains.rate;
}

}  // namespace

ControllerSettings read_controller_settings(const ros::NodeHandle& nh) {
  PrivateParameters own;
  // As plugins of the model, they are checked as those are.
  const std::string name = "controller_node";
  std::vector<PluginElement> guests = {{name, "libcontroller_plugin.so",
                                        own.tags(control::ControllerSetup::tags()),
                                        "controller_node"}};
  const std::vector<PluginTag> reference = reference_tags_of(own);
  if (!reference.empty()) {
    guests.push_back({name + "_reference", reference_file, reference, "parameter ~reference"});
  }
  const std::string node = nh.resolveName(own.text("plant", "quadcore"));
  const PlantWatch watch(node);
  PrivateParameters flown(node);
  const double velocity_timeout = own.positive("velocity_timeout").value_or(0.5);
  own.check_all_known();

  Plant plant = read_plant(flown);
  read_description(nh, plant);
  Simulation simulation =
      make_simulation(plant, read_world_of(plant), [&guests](const Model&) { return guests; });
  const LoadedPlugin* const shape = writer_of(simulation, reference_topic);
  const LoadedPlugin* const controller = writer_of(simulation, Simulation::command_topic);
  ControllerSettings settings{control::ControllerSetup(controller->parameters),
                              nullptr,
                              velocity_timeout,
                              simulation.describe_vehicle(),
                              simulation.dt(),
                              flown.flag("lockstep", false),
                              command_topic(nh, plant, simulation.model()),
                              watch};
  if (shape && shape->filename == reference_file) {
    settings.reference = control::reference_of(shape->parameters, simulation.model());
  }
  control::Gains& gains = settings.setup.gains;
  gains.rate = rate_of(gains, controller->parameters, simulation);
  return settings;
}

}  // namespace quadcore::node
