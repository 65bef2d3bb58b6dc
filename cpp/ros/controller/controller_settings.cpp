#include "controller_settings.hpp"

#include <utility>

#include "odometry_topic.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr const char* reference_file = "libreference_plugin.so";
constexpr const char* reference_topic = "reference";

std::vector<PluginTag> read_reference_tags(PrivateParameters& own) {
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

const LoadedPlugin* find_writer(const Simulation& simulation, const std::string& topic) {
  const int index = simulation.topics().find(topic);
  if (index < 0) return nullptr;
  const int writer = simulation.topics()[static_cast<std::size_t>(index)].writer;
  return writer == the_caller ? nullptr : &simulation.plugins()[static_cast<std::size_t>(writer)];
}

/// Returns the calls per second, which cannot exceed the rate of the odometry.
double choose_rate(const control::Gains& gains, const Parameters& parameters,
                   const Simulation& plant) {
  const LoadedPlugin* const odometry = find_writer(plant, OdometryTopic::name);
  if (!odometry) {
    throw InputError(
        "No plugin of the model publishes odometry on topic odom. Add "
        "libodometry_plugin.so.");
  }
  for (const Parameter& parameter : odometry->parameters.all()) {
    if (parameter.spec.name != "rate") continue;
    const double sent = odometry->parameters.number("rate");
    if (sent >= gains.rate || sent * plant.dt() >= 1) break;
    if (parameters.has("rate") || parameters.has("gains")) {
      throw InputError("parameter ~rate: odometry arrives " + parameter.text +
                       " times a second. Give at most this rate, or increase that of plugin '" +
                       odometry->name + "'.");
    }
    ROS_INFO("the controller is called at the rate of the odometry, %g times a second", sent);
    return sent;
  }
  return gains.rate;
}

}  // namespace

ControllerSettings read_controller_settings(const ros::NodeHandle& nh) {
  PrivateParameters own;
  // Added as plugins of the model, they get the same checks.
  const std::string name = "controller_node";
  std::vector<PluginElement> guests = {{name, "libcontroller_plugin.so",
                                        own.tags(control::ControllerSetup::tags()),
                                        "controller_node"}};
  const std::vector<PluginTag> reference = read_reference_tags(own);
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
  Simulation simulation = make_simulation(plant, read_world_of(plant),
                                          [&guests](const Model&, World&) { return guests; });
  const LoadedPlugin* const shape = find_writer(simulation, reference_topic);
  const LoadedPlugin* const controller = find_writer(simulation, Simulation::command_topic);
  ControllerSettings settings{control::ControllerSetup(controller->parameters),
                              nullptr,
                              velocity_timeout,
                              simulation.describe_vehicle(),
                              simulation.dt(),
                              flown.flag("lockstep", false),
                              resolve_command_topic(nh, plant, simulation.model()),
                              choose_frames(nh, plant.frames, simulation),
                              watch};
  if (shape && shape->filename == reference_file) {
    settings.reference = control::reference_of(shape->parameters, simulation.model());
  }
  control::Gains& gains = settings.setup.gains;
  gains.rate = choose_rate(gains, controller->parameters, simulation);
  return settings;
}

}  // namespace quadcore::node
