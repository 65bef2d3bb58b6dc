#include <ros/network.h>
#include <ros/ros.h>
#include <ros/topic_manager.h>
#include <std_msgs/Float64MultiArray.h>

#include <cstdio>
#include <cstdlib>
#include <future>

#include "broadcast.hpp"
#include "csv_log.hpp"
#include "diagnostics.hpp"
#include "end_signal.hpp"
#include "flight_thread.hpp"
#include "master_watch.hpp"
#include "quadcore/error.hpp"
#include "services.hpp"
#include "settings.hpp"

namespace quadcore::node {
namespace {

using Clock = std::chrono::steady_clock;

/// Takes commands from a topic, on the callback thread.
class CommandSubscriber {
 public:
  CommandSubscriber(ros::NodeHandle& nh, const std::string& topic, FlightThread& flight)
      : flight_(flight) {
    // Queue and type are those of the original; no delay, lest a command waits for the next one.
    subscriber_ = nh.subscribe(topic, 1000, &CommandSubscriber::take, this,
                               ros::TransportHints().tcpNoDelay());
  }
  Refusals refusals() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return refusals_;
  }

 private:
  void take(const std_msgs::Float64MultiArray& message) {
    try {
      flight_.command(message.data);
    } catch (const InputError& error) {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++refusals_.count;
      refusals_.last = error.what();
      // Not ROS_WARN_THROTTLE: it goes by simulation time, which may stand still.
      if (said_ == error.what() || Clock::now() < quiet_until_) return;
      ROS_WARN("%s: %s", subscriber_.getTopic().c_str(), error.what());
      said_ = error.what();
      quiet_until_ = Clock::now() + std::chrono::seconds(1);
    }
  }

  FlightThread& flight_;
  ros::Subscriber subscriber_;
  mutable std::mutex mutex_;
  Refusals refusals_;
  std::string said_;
  Clock::time_point quiet_until_{};
};

/// Sends, and logs if asked to.
class Listener final : public FlightListener {
 public:
  Listener(ros::NodeHandle& nh, const Simulation& simulation, const std::string& command_topic,
           const Settings& settings)
      : command_topic_(command_topic), broadcast_(nh, simulation, settings.flight.lockstep) {
    if (!settings.log.empty()) log_.emplace(settings.log, simulation);
  }
  void observe(const Simulation& simulation, bool jumped) override {
    if (log_) log_->add(simulation.state());
    if (log_ && !log_->error().empty()) ROS_ERROR_ONCE("%s", log_->error().c_str());
    broadcast_.send(simulation, jumped);
  }
  void repeat(const Simulation& simulation) override { broadcast_.send(simulation, true); }
  void warn(const std::string& what) override { ROS_WARN("%s", what.c_str()); }
  bool has_commander() const override {
    return ros::TopicManager::instance()->getNumPublishers(command_topic_) > 0;
  }
  /// Once the flight has ended. Returns what went wrong with the log; "" = nothing.
  std::string close_log() {
    if (!log_) return "";
    log_->close();
    return log_->error();
  }

 private:
  const std::string command_topic_;
  Broadcast broadcast_;
  std::optional<CsvLog> log_;
};

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

/// Where commands come in: below the model's name, as Gazebo has it.
std::string command_topic(const ros::NodeHandle& nh, const Settings& settings, const Model& model) {
  const std::string name = settings.name.empty() ? model.name : settings.name;
  std::string why;
  if (!ros::names::validate(name, why)) {
    throw InputError("model name '" + name + "' cannot name a topic (" + why + "); set ~name");
  }
  return nh.resolveName(name + "/vel_cmd");
}

/// Throws unless a master answers. Without this check a node without one hangs in its first
/// advertise().
void check_master() {
  // In a thread, because roscpp waits without end for a master that is there but mute.
  std::packaged_task<bool()> check(ros::master::check);
  std::future<bool> answer = check.get_future();
  std::thread(std::move(check)).detach();
  const bool in_time = answer.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  if (in_time && answer.get()) return;
  throw InputError((in_time ? "no ROS master at " : "no answer within 5 s from a ROS master at ") +
                   ros::master::getURI() +
                   "; start roscore or use roslaunch, or correct ROS_MASTER_URI");
}

/// Where the master is. roscpp would abort over no or a wrong address.
void check_master_uri() {
  // The default of rospy and the ros tools.
  setenv("ROS_MASTER_URI", "http://localhost:11311", 0);
  const std::string uri = std::getenv("ROS_MASTER_URI");
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    throw InputError("ROS_MASTER_URI: '" + uri +
                     "' is no address; write http://HOST:PORT, such as http://localhost:11311");
  }
}

void run(const EndSignal& end_signal) {
  ros::NodeHandle nh;
  const Settings settings = read_settings(nh);
  if (settings.verbose &&
      ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Debug)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  const World world = settings.world.empty() ? World{} : read_world(Document::read(settings.world));
  Simulation simulation(read_model(settings.model), world, settings.simulation);
  describe(simulation);
  FlightSettings flight_settings = settings.flight;
  flight_settings.real_time_factor =
      settings.real_time_factor.value_or(world.real_time_update_rate * simulation.dt());
  const std::string topic = command_topic(nh, settings, simulation.model());

  Listener listener(nh, simulation, topic, settings);
  FlightThread flight(simulation, flight_settings, listener);
  const CommandSubscriber commands(nh, topic, flight);
  const Services services(nh, flight);
  MasterWatch master_watch(services.names());
  // In lockstep it is the controller that sets the pace.
  Diagnostics diagnostics(nh, flight.report(),
                          flight_settings.lockstep ? 0 : flight_settings.real_time_factor, topic);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ROS_INFO("flying %s with engine %s, commands on %s%s", simulation.model().name.c_str(),
           simulation.engine_name().c_str(), topic.c_str(),
           flight_settings.lockstep ? ", one for each odometry message" : "");

  Clock::time_point due = Clock::now() + std::chrono::seconds(1);
  while (ros::ok() && !end_signal.has_come()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (Clock::now() < due) continue;
    diagnostics.send(flight.report(), commands.refusals());
    due += std::chrono::seconds(1);
  }
  flight.end();
  // Before anything that may take longer than there is time.
  const std::string log_error = listener.close_log();
  spinner.stop();
  master_watch.end();
  ros::shutdown();
  if (!log_error.empty()) throw InputError(log_error);
}

}  // namespace
}  // namespace quadcore::node

int main(int argc, char** argv) {
  const quadcore::node::EndSignal end_signal;
  try {
    quadcore::node::check_master_uri();
    ros::init(argc, argv, "quadcore", ros::init_options::NoSigintHandler);
    quadcore::node::check_master();
    quadcore::node::run(end_signal);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    std::fflush(nullptr);
    std::_Exit(2);  // a master that is mute may still be waited for
  }
  return 0;
}
