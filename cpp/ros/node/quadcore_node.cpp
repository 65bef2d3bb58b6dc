#include <ros/ros.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "command_subscriber.hpp"
#include "diagnostics.hpp"
#include "end_signal.hpp"
#include "flight_thread.hpp"
#include "listener.hpp"
#include "master_check.hpp"
#include "master_watch.hpp"
#include "mean_wind.hpp"
#include "model_claim.hpp"
#include "no_delay.hpp"
#include "parameter_watch.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "reconfigure.hpp"
#include "services.hpp"
#include "settings.hpp"
#include "vehicle_markers.hpp"

namespace quadcore::node {
namespace {

void log_description(const Simulation& simulation) {
  for (const std::string& warning : simulation.warnings()) ROS_WARN("%s", warning.c_str());
  for (const LoadedPlugin& plugin : simulation.plugins()) {
    ROS_DEBUG("plugin %s: %s", plugin.name.c_str(), plugin.path.c_str());
    for (const Parameter& parameter : plugin.parameters.all()) {
      ROS_DEBUG("    %s = %s %s (%s)", parameter.spec.name.c_str(), parameter.text.c_str(),
                parameter.spec.unit.c_str(), parameter.origin.c_str());
    }
  }
}

/// Parameter in the vehicle's namespace.
constexpr const char* frames_parameter = "vehicle_frames";

/// Maximum of the slider of the real-time factor.
constexpr double most_shown_factor = 20;

ros::NodeHandle start_node() {
  ros::NodeHandle nh;
  send_without_delay();
  return nh;
}

/// Sets the initial angles of rotors.
void turn_rotors(Simulation& simulation, const std::map<std::string, double>& angles) {
  const std::vector<std::string> names = simulation.model().joint_names();
  VehicleState state = simulation.state();
  for (const auto& [name, angle] : angles) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw InputError("parameter ~joints: the model has no rotor joint '" + name + "'. It has " +
                       joined(names) + ".");
    }
    state.rotor_angle[found - names.begin()] = angle;
  }
  simulation.set_state(state);
}

/// Makes the simulation and logs its description.
Simulation make_vehicle(const Settings& settings, const World& world) {
  if (settings.verbose &&
      ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Debug)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  Simulation simulation =
      make_simulation(settings.plant, world, [](const Model& model, World& replaced) {
        std::vector<PluginElement> plugins = MeanWind::replace_wind(replaced, model);
        plugins.push_back(GazeboWrenches::plugin(model));
        return plugins;
      });
  if (!settings.joint_angles.empty()) turn_rotors(simulation, settings.joint_angles);
  log_description(simulation);
  return simulation;
}

void say_error(const std::string& error) {
  std::fprintf(stderr, "error: %s\n", error.c_str());
  std::fflush(stderr);
}

/// Publishes the frames of a vehicle as a parameter, for rviz, which reads them from its file only.
Frames publish_frames(const ros::NodeHandle& nh, const Frames& frames, const Model& model) {
  const bool links_have_prefix =
      frames.of_link(model.links.front().name) == model.links.front().name;
  nh.setParam(frames_parameter,
              std::map<std::string, std::string>{
                  {"fixed", frames.map.empty() ? frames.world : frames.map},
                  {"world", frames.world},
                  {"vehicle", frames.vehicle},
                  {"prefix", links_have_prefix ? "" : nh.getNamespace().substr(1)}});
  return frames;
}

/// The node. Its members are in the order of their construction: the simulation, the clock, topics,
/// the flight, services.
class Node {
 public:
  /// \return exit status
  int run(const EndSignal& end_signal) {
    connect();
    watch(end_signal);
    return end(end_signal);
  }

 private:
  FlightSettings flight_settings() const {
    FlightSettings settings = settings_.flight;
    settings.follows_clock = !clock_;
    settings.real_time_factor =
        settings_.real_time_factor.value_or(world_.real_time_update_rate * simulation_.dt());
    return settings;
  }

  std::vector<std::string> simulated_topics() const {
    std::vector<std::string> topics = list_simulated(topics_);
    topics.push_back(GazeboWrenches::topic);
    return topics;
  }

  /// Returns the values that rqt_reconfigure shows.
  std::vector<Adjustable> adjustables() {
    std::vector<Adjustable> values;
    values.push_back({"paused", "whether the flight is paused", true, 0, 1,
                      [this] { return static_cast<double>(flight_.report().paused); },
                      [this](double paused) { flight_.set_paused(paused != 0); }});
    if (clock_) {  // otherwise the leader sets the pace
      values.push_back({"real_time_factor", "simulated seconds per second; 0: no limit", false, 0,
                        most_shown_factor, [this] { return flight_.report().real_time_factor; },
                        [this](double factor) {
                          const XmlRpc::XmlRpcValue value(factor);
                          flight_.set_real_time_factor(to_non_negative("real_time_factor", value));
                        }});
    }
    const std::vector<Adjustable> wind = wind_.adjustables(flight_);
    values.insert(values.end(), wind.begin(), wind.end());
    return values;
  }

  /// Returns the parameters that other nodes read. They are set again after a restart of the
  /// master.
  MasterWatch::Parameters public_parameters() const {
    MasterWatch::Parameters parameters;
    for (const std::string& key :
         {std::string(use_sim_time), settings_.plant.description, std::string(frames_parameter)}) {
      if (!key.empty()) nh_.getParam(key, parameters[key]);
    }
    return parameters;
  }

  /// Runs `send` between two steps, for a new subscriber.
  void send_between_steps(const std::function<void(const Simulation&)>& send) {
    try {
      flight_.run_between_steps(send);
    } catch (const InputError&) {
      // The flight ends; a new subscriber gets no message.
    }
  }

  void send_gazebo_states() {
    send_between_steps([this](const Simulation& now) { gazebo_states_.send(now); });
  }

  /// Connects the node: callbacks first, then the services, because a node that has waited for a
  /// service expects all topics to exist.
  void connect() {
    ROS_INFO("simulating %s with engine %s, commands on %s%s", simulation_.model().name.c_str(),
             simulation_.engine_name().c_str(), join_names(topics_).c_str(),
             settings_.flight.lockstep ? ", one for each odometry message" : "");
    gazebo_states_.for_newcomers([this] { send_gazebo_states(); });
    if (neighbours_) {
      neighbours_->on_message([this](bool complete) {
        // During a flight, the next step sends them.
        if (complete || flight_.report().paused) send_gazebo_states();
      });
    }
    if (follower_) follower_->follow(flight_);
    spinner_.start();
    services_.emplace(nh_, simulation_, flight_, model_, wrenches_, neighbours_.get());
    std::vector<std::string> services = services_->names();
    services.push_back(reconfigure_.service());
    master_watch_.emplace(services, public_parameters(), [this] { parameters_.poll(); });
  }

  /// Runs until the signal to end.
  void watch(const EndSignal& end_signal) {
    using Wall = std::chrono::steady_clock;
    Wall::time_point due = Wall::now() + std::chrono::seconds(1);
    bool stopped = false;
    while (ros::ok() && !end_signal.has_come()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (leader_) {
        leader_->poll();
        neighbours_->update(leader_->spaces(), gazebo_states_.asks_neighbours());
      }
      if (follower_) follower_->report_progress(flight_.report());
      if (broadcast_.has_unserved_subscriber()) {
        send_between_steps(
            [this](const Simulation& now) { broadcast_.serve_new_subscribers(now); });
      }
      const FlightReport report = flight_.report();
      const bool is_alarm = report.commands_stopped && !stopped;  // at once
      stopped = report.commands_stopped;
      if (!is_alarm && Wall::now() < due) continue;
      diagnostics_.send(report, commands_.refusals());
      reconfigure_.update();
      if (!is_alarm) due += std::chrono::seconds(1);
    }
  }

  int end(const EndSignal& end_signal) {
    flight_.end();
    end_signal.flight_is_being_written();
    // Before anything that may take long.
    const std::string log_error = listener_.close_log();
    if (!log_error.empty()) say_error(log_error);
    const int status = log_error.empty() ? 0 : 2;
    end_signal.flight_ended_with(status);
    spinner_.stop();
    master_watch_->end();
    ros::shutdown();
    return status;
  }

  ros::NodeHandle nh_ = start_node();
  ParameterWatch::Values initial_parameters_ =
      ParameterWatch::read();  // they may change during the set-up
  Settings settings_ = read_settings(nh_);
  World world_ = read_world_of(settings_.plant);
  Simulation simulation_ = make_vehicle(settings_, world_);
  std::string model_ = choose_model_name(settings_.plant, simulation_.model());
  ros::Publisher claim_ = claim_model(nh_, model_);

  // This node either leads the clock and has neighbours that follow it, or it follows.
  ClockPublisher clock_ = take_part_in_clock(nh_, settings_.clock, settings_.clock_rate);
  std::unique_ptr<ClockFollower> follower_ =
      clock_ ? nullptr : std::make_unique<ClockFollower>(nh_, simulation_.dt());
  std::unique_ptr<GazeboNeighbours> neighbours_ =
      clock_ ? std::make_unique<GazeboNeighbours>(nh_) : nullptr;

  Frames frames_ = publish_frames(nh_, choose_frames(nh_, settings_.plant.frames, simulation_),
                                  simulation_.model());
  GazeboStates gazebo_states_{nh_, simulation_, model_, neighbours_.get()};
  VehicleMarkers markers_{nh_, simulation_, frames_};
  Broadcast broadcast_{nh_, simulation_, clock_, frames_, gazebo_states_, settings_.rotor_tf};
  std::vector<CommandTopic> topics_ = find_command_topics(nh_, settings_.plant, simulation_);
  TopicInlets inlets_{nh_, simulation_, simulated_topics(), settings_.flight.lockstep};
  GazeboWrenches wrenches_;
  MeanWind wind_{simulation_};
  Listener listener_{broadcast_,
                     inlets_,
                     wrenches_,
                     wind_,
                     simulation_,
                     topics_,
                     settings_.log.empty()
                         ? nullptr
                         : open_log(settings_.log, simulation_, settings_.log_topics,
                                    settings_.log_every, nh_, frames_),
                     follower_.get()};

  FlightThread flight_{simulation_, flight_settings(), listener_};
  std::unique_ptr<ClockLeader> leader_ =
      clock_ ? std::make_unique<ClockLeader>(nh_, flight_, clock_) : nullptr;
  CommandSubscriber commands_{nh_, topics_, flight_};
  ParameterWatch parameters_{flight_, !clock_, initial_parameters_};
  Reconfigure reconfigure_{adjustables()};
  Diagnostics diagnostics_{nh_, flight_.report(), join_names(topics_)};

  ros::AsyncSpinner spinner_{1};
  std::optional<Services> services_;
  std::optional<MasterWatch> master_watch_;
};

}  // namespace
}  // namespace quadcore::node

int main(int argc, char** argv) {
  const quadcore::node::EndSignal end_signal;
  try {
    quadcore::node::check_master_uri();
    ros::init(argc, argv, "quadcore", ros::init_options::NoSigintHandler);
    quadcore::node::check_master();
    return quadcore::node::Node().run(end_signal);
  } catch (const std::exception& error) {
    quadcore::node::say_error(error.what());
    std::_Exit(2);  // a thread may still wait for an unresponsive master
  }
}
