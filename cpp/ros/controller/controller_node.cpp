#include <geometry_msgs/Vector3Stamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "active_aim.hpp"
#include "controller_settings.hpp"
#include "master_check.hpp"
#include "messages.hpp"
#include "no_delay.hpp"
#include "reconfigure.hpp"
#include "ros_types.hpp"
#include "set_points.hpp"
#include "warning_limiter.hpp"

namespace quadcore::node {
namespace {

constexpr double between_checks = 5;  ///< s

bool is_valid(const control::Odometry& now) {
  return now.position.allFinite() && is_unit(now.orientation) && now.linear_velocity.allFinite() &&
         now.angular_velocity.allFinite();
}

/// Answers each odometry message with a command.
class ControllerNode {
 public:
  ControllerNode(ros::NodeHandle& nh, ControllerSettings settings)
      : setup_(settings.setup),
        vehicle_(std::move(settings.vehicle)),
        controller_(setup_.controller(vehicle_)),
        inner_loop_(make_inner_loop(setup_)),
        schedule_(setup_.schedule(controller_.rotors())),
        active_aim_(settings.reference),
        set_points_(nh, settings.frames.world, settings.velocity_timeout, active_aim_),
        plant_(std::move(settings.plant)),
        dt_(settings.dt) {
    ros::NodeHandle own("~");
    command_.data.resize(controller_.rotors());
    set_frames(reference_, {settings.frames.world, settings.frames.vehicle});
    error_.header.frame_id = settings.frames.world;
    reference_publisher_ = own.advertise<nav_msgs::Odometry>("reference", queue_size);
    error_publisher_ = own.advertise<geometry_msgs::Vector3Stamped>("error", queue_size);
    command_publisher_ =
        nh.advertise<std_msgs::Float64MultiArray>(settings.command_topic, queue_size);
    // Without lockstep, only the last message is used.
    odometry_subscriber_ =
        nh.subscribe("odom", settings.lockstep ? queue_size : 1, &ControllerNode::control, this,
                     ros::TransportHints().tcpNoDelay());
    check_ = nh.createWallTimer(ros::WallDuration(between_checks), &ControllerNode::check, this);
  }

  /// Whether the plant has other parameters than the controller's model.
  bool is_outdated() const { return is_outdated_; }

 private:
  /// Warns once about missing or conflicting connections.
  void check(const ros::WallTimerEvent&) {
    const std::string odometry = odometry_subscriber_.getTopic();
    const std::uint32_t sources = odometry_subscriber_.getNumPublishers();
    std::string what;
    if (command_publisher_.getNumSubscribers() == 0) {
      what = "No node receives commands on " + command_publisher_.getTopic() +
             ". Name the plant with _plant:=NAME.";
    } else if (sources == 0) {
      what = "No node publishes odometry on " + odometry + ". Remap it with odom:=TOPIC.";
    } else if (sources > 1) {
      what = std::to_string(sources) + " nodes publish odometry on " + odometry +
             ". Put each vehicle in its own namespace.";
    }
    if (!what.empty() && what != last_warning_) ROS_WARN("%s", what.c_str());
    last_warning_ = what;
  }

  void control(const nav_msgs::Odometry& message) {
    // Counts steps, because a stamp is rounded.
    const double step = std::round(message.header.stamp.toSec() / dt_);
    if (schedule_state_.empty() || step < last_step_) {
      is_outdated_ = plant_.has_changed();
      if (is_outdated_) return;
      if (step < last_step_) active_aim_.begin();
      begin(step);
    }
    last_step_ = step;
    const control::Odometry now = setup_.in_world(from_ros(message));
    if (!is_valid(now)) {
      limiter_.warn(
          odometry_subscriber_.getTopic() +
          ": contains numbers that are not finite, or a quaternion of another length than 1. "
          "The last command is kept.");
      command_publisher_.publish(command_);
      return;
    }
    const Aim aim = active_aim_.at(step * dt_, now);
    const auto ask = [&](double period, double* speeds) {
      std::visit([&](const auto& wanted) { compute_speeds(period, now, wanted, speeds); }, aim);
    };
    const double* const speeds =
        schedule_.update(step - first_step_, dt_, schedule_state_.data(), ask);
    if (speeds) std::copy_n(speeds, command_.data.size(), command_.data.begin());
    command_publisher_.publish(command_);
    if (const auto* const wanted = std::get_if<control::Reference>(&aim)) {
      publish_reference(message.header.stamp, now, *wanted);
    }
  }

  control::InnerLoop make_inner_loop(const control::ControllerSetup& setup) const {
    return {setup.describe_model(vehicle_),
            control::select_values(control::InnerLoop::table(), setup.gains.values), setup.spins};
  }

  /// Returns the gains for rqt_reconfigure, with sliders to four times the initial value if a gain
  /// has no maximum.
  std::vector<Adjustable> adjustables() {
    std::vector<Adjustable> values;
    for (const TagSpec& spec : control::Controller::table(setup_.gains.law)) {
      if (spec.fallback.empty()) continue;  // no default value
      const double initial = gain(spec);
      const double reach = initial == 0 ? 1 : 4 * std::abs(initial);
      values.push_back({spec.name, spec.meaning, spec.kind == TagKind::flag,
                        std::isfinite(spec.min) ? spec.min : -reach,
                        std::isfinite(spec.max) ? spec.max : reach,
                        [this, spec] { return gain(spec); },
                        [this, name = spec.name](double value) { set_gain(name, value); }});
    }
    return values;
  }

  double gain(const TagSpec& spec) const {
    const auto found = setup_.gains.values.find(spec.name);
    return found == setup_.gains.values.end() ? control::default_of(spec) : found->second;
  }

  /// Replaces a gain. The controller keeps its state, for example its integrals.
  void set_gain(const std::string& name, double value) {
    control::ControllerSetup changed = setup_;
    changed.gains.values[name] = value;
    controller_ = changed.controller(vehicle_);
    inner_loop_ = make_inner_loop(changed);
    setup_ = changed;
  }

  /// Restarts at the first message, and when the time was set back.
  void begin(double step) {
    schedule_state_.assign(schedule_.state_size(), 0);
    state_.clear();
    inner_state_.clear();
    first_step_ = step;
  }

  // The controller restarts after the inner loop was used, and vice versa.

  void compute_speeds(double period, const control::Odometry& now, const control::Reference& wanted,
                      double* speeds) {
    inner_state_.clear();
    state_.resize(control::Controller::state_size(setup_.gains.law, controller_.rotors()));
    controller_.command(period, now, wanted, state_.data(), speeds);
  }
  template <class Wanted>
  void compute_speeds(double period, const control::Odometry& now, const Wanted& wanted,
                      double* speeds) {
    state_.clear();
    inner_state_.resize(control::InnerLoop::state_size(inner_loop_.rotors()));
    inner_loop_.command(period, now, wanted, inner_state_.data(), speeds);
  }

  void publish_reference(const ros::Time& stamp, const control::Odometry& now,
                         const control::Reference& wanted) {
    messages::Odometry where;
    where.position = wanted.position;
    where.orientation = Eigen::AngleAxisd(wanted.yaw, Vector3d::UnitZ());
    where.linear_velocity = setup_.in_body ? where.orientation.conjugate() * wanted.velocity
                                           : Vector3d(wanted.velocity);
    where.angular_velocity.z() = wanted.yaw_rate;
    to_ros(where, reference_);
    reference_.header.stamp = error_.header.stamp = stamp;
    reference_publisher_.publish(reference_);
    const Vector3d error = wanted.position - now.position;
    set_vector(error_.vector, error.data());
    error_publisher_.publish(error_);
  }

  control::ControllerSetup setup_;
  VehicleDescription vehicle_;
  control::Controller controller_;
  control::InnerLoop inner_loop_;
  control::Schedule schedule_;
  ActiveAim active_aim_;
  SetPoints set_points_;
  PlantWatch plant_;
  double dt_;
  std::vector<double> schedule_state_, state_, inner_state_;  ///< empty before the first message
  double first_step_ = 0, last_step_ = 0;
  bool is_outdated_ = false;
  std::string last_warning_;  ///< of the last check
  WarningLimiter limiter_;

  std_msgs::Float64MultiArray command_;
  nav_msgs::Odometry reference_;
  geometry_msgs::Vector3Stamped error_;
  ros::Publisher command_publisher_, reference_publisher_, error_publisher_;
  ros::Subscriber odometry_subscriber_;
  ros::WallTimer check_;
  Reconfigure reconfigure_{adjustables()};
};

void run() {
  ros::NodeHandle nh;
  send_without_delay();
  while (ros::ok()) {
    ControllerSettings settings = read_controller_settings(nh);
    ROS_INFO("controller %s commands %s", settings.setup.gains.law.c_str(),
             settings.command_topic.c_str());
    const ControllerNode node(nh, std::move(settings));
    while (ros::ok() && !node.is_outdated()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    }
  }
}

}  // namespace
}  // namespace quadcore::node

int main(int argc, char** argv) {
  try {
    quadcore::node::check_master_uri();
    ros::init(argc, argv, "controller");
    quadcore::node::check_master();
    quadcore::node::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return 0;
}
