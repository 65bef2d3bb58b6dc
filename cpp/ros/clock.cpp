#include "clock.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "master_api.hpp"
#include "quadcore/error.hpp"

namespace quadcore::node {
namespace {

using XmlRpc::XmlRpcValue;
using Wall = std::chrono::steady_clock;

/// Followers tell how far they are at least so often.
constexpr auto longest_silence = std::chrono::seconds(1);
/// By then a connection to the leader has been made, or has failed.
constexpr auto longest_connecting = std::chrono::seconds(5);
/// They tell it after each such piece of time [s of simulation].
constexpr double telling_period = longest_lead / 4;

bool is_alive(const std::string& node) {
  XmlRpcValue uri, pid;
  return call_master("lookupNode", {node}, uri) &&
         call_node(static_cast<std::string>(uri), "getPid", {}, pid);
}

/// The first living node that publishes a topic; the master lists them in the order in which they
/// came. "" = none before this one.
std::string first_publisher(const std::string& topic) {
  XmlRpcValue state;
  if (!call_master("getSystemState", {}, state)) return "";
  XmlRpcValue& topics = state[0];
  for (int i = 0; i < topics.size(); ++i) {
    if (static_cast<std::string>(topics[i][0]) != topic) continue;
    XmlRpcValue& publishers = topics[i][1];
    for (int j = 0; j < publishers.size(); ++j) {
      const std::string node = publishers[j];
      if (node == ros::this_node::getName()) return "";
      if (is_alive(node)) return node;
    }
  }
  return "";
}

}  // namespace

KeptPublisher<rosgraph_msgs::Clock> take_part_in_clock(ros::NodeHandle& nh, ClockRole role) {
  if (role == ClockRole::follow) return {};
  KeptPublisher<rosgraph_msgs::Clock> publisher(nh, "/clock", 1000, Again::to_all);
  const std::string leader = first_publisher("/clock");
  if (leader.empty()) {
    // As gazebo_ros does; before there are services, so that whoever waits for one finds it.
    if (!nh.hasParam(use_sim_time)) nh.setParam(use_sim_time, true);
    return publisher;
  }
  if (role == ClockRole::lead) {
    throw InputError("parameter ~clock: is lead, but " + leader +
                     " publishes /clock already; there can be one clock only, follow it");
  }
  publisher.shutdown();
  ROS_INFO("following /clock of %s", leader.c_str());
  return {};
}

ClockLeader::ClockLeader(ros::NodeHandle& nh, FlightThread& flight,
                         const KeptPublisher<rosgraph_msgs::Clock>& clock)
    : flight_(flight),
      clock_(clock),
      subscriber_(nh.subscribe(followers_topic, 1000, &ClockLeader::take, this,
                               ros::TransportHints().tcpNoDelay())) {}

void ClockLeader::take(const std_msgs::Header& needs) {
  if (needs.stamp.isZero()) return clock_.repeat();
  const std::lock_guard<std::mutex> lock(mutex_);
  followers_[needs.frame_id] = {needs.stamp.toSec(), Wall::now()};
  hold();
}

void ClockLeader::look() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto silent_since = Wall::now() - longest_silence;
  const std::size_t before = followers_.size();
  for (auto follower = followers_.begin(); follower != followers_.end();) {
    follower =
        follower->second.heard < silent_since ? followers_.erase(follower) : std::next(follower);
  }
  if (followers_.size() != before) hold();
}

std::vector<std::string> ClockLeader::spaces() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> spaces;
  for (const auto& [name, follower] : followers_)
    spaces.push_back(ros::names::parentNamespace(name));
  return spaces;
}

void ClockLeader::hold() {
  double slowest = std::numeric_limits<double>::infinity();
  for (const auto& [name, follower] : followers_) slowest = std::min(slowest, follower.needs);
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
  if (std::abs(time - told_) < telling_period) return;
  told_ = time;
  tell(ros::Time(time + dt_));
}

void ClockFollower::tell(const FlightReport& report) {
  if (report.waits_for_clock) {
    // roscpp does not try a connection twice.
    if (Wall::now() - subscribed_ > longest_connecting) subscribe();
    // What a leader keeps for those who come may have come to roscpp's own subscription alone.
    tell(ros::Time());
  } else if (report.paused || !report.failure.empty()) {
    tell(ros::TIME_MAX);
  } else {
    tell(ros::Time(report.time + dt_));
  }
}

void ClockFollower::tell(const ros::Time& needs) {
  std_msgs::Header header;
  header.frame_id = ros::this_node::getName();
  header.stamp = needs;
  publisher_.publish(header);
}

}  // namespace quadcore::node
