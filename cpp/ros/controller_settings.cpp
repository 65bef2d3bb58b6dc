#include "controller_settings.hpp"

#include <utility>

#include "odometry_topic.hpp"
#include "quadcore/error.hpp"

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

/// A law cannot be called more often than it is told something.
void check_rate(const control::ControllerSetup& setup, const Simulation& plant) {
  const LoadedPlugin* const odometry = writer_of(plant, OdometryTopic::name);
  if (!odometry) {
    throw InputError(
        "no plugin of the model publishes odometry on topic odom; add "
        "libodometry_plugin.so");
  }
  for (const Parameter& parameter : odometry->parameters.all()) {
    if (parameter.spec.name != "rate") continue;
    const double sent = odometry->parameters.number("rate");
    if (sent >= setup.gains.rate || sent * plant.dt() >= 1) return;
    throw InputError("parameter ~rate: odometry comes " + parameter.text +
                     " times a second; give that at most, or let plugin '" + odometry->name +
                     "' send more");
  }
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
  PrivateParameters flown(nh.resolveName(own.text("plant", "quadcore")));
  const double velocity_timeout = own.no_negative("velocity_timeout").value_or(0.5);
  own.check_all_known();

  Plant plant = read_plant(flown);
  read_description(nh, plant);
  Simulation simulation = make_simulation(plant, read_world_of(plant), guests);
  const LoadedPlugin* const shape = writer_of(simulation, reference_topic);
  const LoadedPlugin* const controller = writer_of(simulation, Simulation::command_topic);
  ControllerSettings settings{control::ControllerSetup(controller->parameters),
                              nullptr,
                              velocity_timeout,
                              simulation.describe_vehicle(),
                              simulation.dt(),
                              flown.flag("lockstep", false),
                              command_topic(nh, plant, simulation.model())};
  if (shape && shape->filename == reference_file) {
    settings.reference = control::reference_of(shape->parameters);
  }
  check_rate(settings.setup, simulation);
  return settings;
}

}  // namespace quadcore::node
