#include "clock.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "master_api.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

using Wall = std::chrono::steady_clock;

/// The leader does not wait for followers that are silent for longer.
constexpr auto longest_silence = std::chrono::seconds(1);
/// After this time of silence, a follower counts as ended.
constexpr auto longest_absence = std::chrono::seconds(5);
/// By then, a connection to the leader exists or has failed.
constexpr auto longest_connecting = std::chrono::seconds(5);
/// Interval of the followers' reports [s of simulation].
constexpr double reporting_period = longest_lead / 4;

}  // namespace

ClockPublisher take_part_in_clock(ros::NodeHandle& nh, ClockRole role, double rate) {
  if (role == ClockRole::follow) return {};
  ClockPublisher publisher(nh, rate);
  const std::string leader = find_earlier_publisher("/clock");
  if (leader.empty()) {
    // Like gazebo_ros; before the services exist, so that a node that waits for a service finds it.
    if (!nh.hasParam(use_sim_time)) nh.setParam(use_sim_time, true);
    return publisher;
  }
  if (role == ClockRole::lead) {
    throw InputError("parameter ~clock: is lead, but " + leader +
                     " already publishes /clock. Set it to follow.");
  }
  publisher.shutdown();
  ROS_INFO("following /clock of %s", leader.c_str());
  return {};
}

ClockLeader::ClockLeader(ros::NodeHandle& nh, FlightThread& flight, const ClockPublisher& clock)
    : flight_(flight),
      clock_(clock),
      subscriber_(nh.subscribe(followers_topic, 1000, &ClockLeader::take, this,
                               ros::TransportHints().tcpNoDelay())) {}

void ClockLeader::take(const std_msgs::Header& needs) {
  clock_.serve_follower();
  if (needs.stamp.isZero()) return clock_.repeat();
  const std::lock_guard<std::mutex> lock(mutex_);
  followers_[needs.frame_id] = {needs.stamp.toSec(), Wall::now()};
  hold();
}

void ClockLeader::poll() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto gone_since = Wall::now() - longest_absence;
  for (auto follower = followers_.begin(); follower != followers_.end();) {
    follower =
        follower->second.heard < gone_since ? followers_.erase(follower) : std::next(follower);
  }
  hold();
}

std::vector<std::string> ClockLeader::spaces() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> spaces;
  for (const auto& [name, follower] : followers_)
    spaces.push_back(ros::names::parentNamespace(name));
  return spaces;
}

void ClockLeader::hold() {
  const auto silent_since = Wall::now() - longest_silence;
  double slowest = std::numeric_limits<double>::infinity();
  for (const auto& [name, follower] : followers_) {
    if (follower.heard >= silent_since) slowest = std::min(slowest, follower.needs);
  }
  if (slowest == slowest_) return;
  slowest_ = slowest;
  flight_.hold(slowest + longest_lead);
}

ClockFollower::ClockFollower(ros::NodeHandle& nh, double dt)
    : nh_(nh), dt_(dt), publisher_(nh.advertise<std_msgs::Header>(followers_topic, 1000)) {}

void ClockFollower::follow(FlightThread& flight) {
  flight_ = &flight;
  subscribe();
}

void ClockFollower::subscribe() {
  subscriber_.shutdown();
  subscriber_ = nh_.subscribe<rosgraph_msgs::Clock>(
      "/clock", 1000,
      [this](const rosgraph_msgs::Clock::ConstPtr& clock) { flight_->clock(clock->clock.toSec()); },
      {}, ros::TransportHints().tcpNoDelay());
  subscribed_ = Wall::now();
}

void ClockFollower::reached(double time) {
  if (std::abs(time - reported_) < reporting_period) return;
  reported_ = time;
  report_progress(ros::Time(time + dt_));
}

void ClockFollower::report_progress(const FlightReport& report) {
  if (report.waits_for_clock) {
    // roscpp does not repeat a failed connection.
    if (Wall::now() - subscribed_ > longest_connecting) subscribe();
    // The leader's latched message may have reached only roscpp's own subscription.
    report_progress(ros::Time());
  } else if (report.paused || !report.failure.empty()) {
    report_progress(ros::TIME_MAX);
  } else {
    report_progress(ros::Time(report.time + dt_));
  }
}

void ClockFollower::report_progress(const ros::Time& needs) {
  std_msgs::Header header;
  header.frame_id = ros::this_node::getName();
  header.stamp = needs;
  publisher_.publish(header);
}

}  // namespace quadcore::node
