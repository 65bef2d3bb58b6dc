#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "command_subscriber.hpp"
#include "diagnostics.hpp"
#include "end_signal.hpp"
#include "flight_thread.hpp"
#include "listener.hpp"
#include "master_check.hpp"
#include "master_watch.hpp"
#include "model_claim.hpp"
#include "no_delay.hpp"
#include "parameter_watch.hpp"
#include "quadcore/plugin/error.hpp"
#include "services.hpp"
#include "settings.hpp"
#include "vehicle_markers.hpp"

namespace quadcore::node {
namespace {

using Wall = std::chrono::steady_clock;

void describe(const Simulation& simulation) {
  for (const std::string& warning : simulation.warnings()) ROS_WARN("%s", warning.c_str());
  for (const LoadedPlugin& plugin : simulation.plugins()) {
    ROS_DEBUG("plugin %s: %s", plugin.name.c_str(), plugin.path.c_str());
    for (const Parameter& parameter : plugin.parameters.all()) {
      ROS_DEBUG("    %s = %s %s (%s)", parameter.spec.name.c_str(), parameter.text.c_str(),
                parameter.spec.unit.c_str(), parameter.origin.c_str());
    }
  }
}

/// What others ask the parameter server for, to be there again after a restart of the master.
MasterWatch::Parameters public_parameters(const ros::NodeHandle& nh, const Settings& settings) {
  MasterWatch::Parameters parameters;
  for (const std::string& key : {std::string(use_sim_time), settings.plant.description}) {
    if (!key.empty()) nh.getParam(key, parameters[key]);
  }
  return parameters;
}

void say_error(const std::string& error) {
  std::fprintf(stderr, "error: %s\n", error.c_str());
  std::fflush(stderr);
}

/// Exit status.
int run(const EndSignal& end_signal) {
  ros::NodeHandle nh;
  send_without_delay();
  ParameterWatch::Values given = ParameterWatch::read();  // somebody may change them meanwhile
  const Settings settings = read_settings(nh);
  if (settings.verbose &&
      ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Debug)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  const World world = read_world_of(settings.plant);
  Simulation simulation = make_simulation(settings.plant, world, [](const Model& model) {
    return std::vector<PluginElement>{GazeboWrenches::plugin(model)};
  });
  const std::string model = model_name(settings.plant, simulation.model());
  describe(simulation);
  const ros::Publisher claim = claim_model(nh, model);

  const KeptPublisher<rosgraph_msgs::Clock> clock = take_part_in_clock(nh, settings.clock);
  FlightSettings flight_settings = settings.flight;
  flight_settings.follows_clock = !clock;
  flight_settings.real_time_factor =
      settings.real_time_factor.value_or(world.real_time_update_rate * simulation.dt());
  const std::string prefix = frame_prefix(nh);

  std::optional<ClockFollower> follower;
  if (!clock) follower.emplace(nh, simulation.dt());
  std::optional<GazeboNeighbours> neighbours;
  if (clock) neighbours.emplace(nh);
  const GazeboNeighbours* const known = neighbours ? &*neighbours : nullptr;
  GazeboStates gazebo_states(nh, simulation, model, known);
  const VehicleMarkers markers(nh, simulation, prefix);
  Broadcast broadcast(nh, simulation, clock, prefix, gazebo_states, settings.rotor_tf);
  const std::vector<CommandTopic> topics = command_topics(nh, settings.plant, simulation);
  std::vector<std::string> taken = simulated(topics);
  taken.push_back(GazeboWrenches::topic);
  TopicInlets inlets(nh, simulation, taken, flight_settings.lockstep);
  GazeboWrenches wrenches;
  std::unique_ptr<LogPerFlight> log;
  if (!settings.log.empty()) {
    log = open_log(settings.log, simulation, settings.log_topics, nh, prefix);
  }
  Listener listener(broadcast, inlets, wrenches, simulation, topics, std::move(log),
                    follower ? &*follower : nullptr);
  ROS_INFO("flying %s with engine %s, commands on %s%s", simulation.model().name.c_str(),
           simulation.engine_name().c_str(), described(topics).c_str(),
           flight_settings.lockstep ? ", one for each odometry message" : "");
  FlightThread flight(simulation, flight_settings, listener);
  const auto send_gazebo_states = [&] {
    try {
      flight.tell([&](const Simulation& now) { gazebo_states.send(now); });
    } catch (const InputError&) {
      // The flight ends; who comes now has nothing more to see.
    }
  };
  gazebo_states.for_newcomers(send_gazebo_states);
  if (neighbours) {
    neighbours->when_heard([&](bool complete) {
      // In flight the next step sends them.
      if (complete || flight.report().paused) send_gazebo_states();
    });
  }
  std::optional<ClockLeader> leader;
  if (clock) leader.emplace(nh, flight, clock);
  if (follower) follower->follow(flight);
  const CommandSubscriber commands(nh, topics, flight_settings.lockstep, flight);
  ParameterWatch parameters(flight, !clock, std::move(given));
  Diagnostics diagnostics(nh, flight.report(), described(topics));
  ros::AsyncSpinner spinner(1);
  spinner.start();
  // Last: whoever has waited for a service finds everything else there.
  const Services services(nh, simulation, flight, model, wrenches, known);
  MasterWatch master_watch(services.names(), public_parameters(nh, settings),
                           [&parameters] { parameters.look(); });

  Wall::time_point due = Wall::now() + std::chrono::seconds(1);
  while (ros::ok() && !end_signal.has_come()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (leader) leader->look();
    if (leader) neighbours->look(leader->spaces(), gazebo_states.asks_neighbours());
    if (follower) follower->tell(flight.report());
    if (Wall::now() < due) continue;
    diagnostics.send(flight.report(), commands.refusals());
    due += std::chrono::seconds(1);
  }
  flight.end();
  end_signal.flight_is_being_written();
  // Before anything that may take longer than there is time.
  const std::string log_error = listener.close_log();
  if (!log_error.empty()) say_error(log_error);
  const int status = log_error.empty() ? 0 : 2;
  end_signal.flight_ended_with(status);
  spinner.stop();
  master_watch.end();
  ros::shutdown();
  return status;
}

}  // namespace
}  // namespace quadcore::node

int main(int argc, char** argv) {
  const quadcore::node::EndSignal end_signal;
  try {
    quadcore::node::check_master_uri();
    ros::init(argc, argv, "quadcore", ros::init_options::NoSigintHandler);
    quadcore::node::check_master();
    return quadcore::node::run(end_signal);
  } catch (const std::exception& error) {
    quadcore::node::say_error(error.what());
    std::_Exit(2);  // a master that is mute may still be waited for
  }
}
