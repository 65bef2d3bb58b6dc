#include "bag_log.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "ros_types.hpp"

namespace quadcore::node {
namespace {

constexpr double never = std::numeric_limits<double>::quiet_NaN();

/// Returns the time in a bag, which has no message at time 0.
ros::Time to_bag_time(const ros::Time& time) { return std::max(time, ros::TIME_MIN); }

}  // namespace

BagLog::BagLog(const std::string& path, const Simulation& simulation, LogRow row,
               const ros::NodeHandle& nh, const Frames& frames)
    : path_(path), active_(path + ".active"), row_(std::move(row)), bag_(active_) {
  if (!bag_.is_open()) throw InputError(describe_open_failure(path_));
  set_frames(odometry_, {frames.world, frames.vehicle});
  tf_.transforms.push_back(make_identity_transform(frames.world, frames.vehicle));
  joints_.name = simulation.model().joint_names();
  clock_number_ = bag_.add<rosgraph_msgs::Clock>("/clock");
  truth_number_ = bag_.add<nav_msgs::Odometry>(nh.resolveName(truth_topic));
  tf_number_ = bag_.add<tf2_msgs::TFMessage>("/tf");
  joints_number_ = bag_.add<sensor_msgs::JointState>(nh.resolveName(joint_states_topic));
  for (const std::size_t index : row_.topics()) {
    const Topic& topic = simulation.topics()[index];
    Logged logged{index, 0, topic.kind == messages::kind_of<messages::Odometry>(), never, {}};
    const std::string name = nh.resolveName(topic.name);
    logged.number = logged.is_odometry ? bag_.add<nav_msgs::Odometry>(name)
                                       : bag_.add<std_msgs::Float64MultiArray>(name);
    add_dimension(logged.array, joined(topic.kind.fields), topic.kind.fields.size());
    topics_.push_back(std::move(logged));
  }
  row_number_ = bag_.add<std_msgs::Float64MultiArray>("/quadcore/log");
  add_dimension(whole_row_, row_.header(), row_.columns().size());
  for (const std::string& name : simulation.ignored()) add_dimension(whole_row_, name, 1);
}

void BagLog::add(const Simulation& simulation) {
  const ros::Time time = to_ros(simulation.time());
  const VehicleState& state = simulation.state();
  add_truth(state, time);
  if (slow_rate_.due(simulation.time(), false)) add_slow(state, time);
  for (Logged& logged : topics_) {
    const Topic& topic = simulation.topics()[logged.index];
    if (topic.count > 0 && topic.stamp != logged.stamp) add(topic, logged);
  }
  whole_row_.data = row_.fill(simulation);
  bag_.write(row_number_, to_bag_time(time), whole_row_);
  if (!bag_.is_whole() && error().empty()) fail(describe_truncation(path_));
}

void BagLog::add_truth(const VehicleState& state, const ros::Time& time) {
  messages::Odometry truth;
  truth.position = state.position;
  truth.orientation = state.orientation;
  truth.linear_velocity = state.linear_velocity;
  truth.angular_velocity = state.angular_velocity;
  odometry_.header.stamp = time;
  to_ros(truth, odometry_);
  bag_.write(truth_number_, to_bag_time(time), odometry_);
}

void BagLog::add_slow(const VehicleState& state, const ros::Time& time) {
  clock_.clock = time;
  bag_.write(clock_number_, to_bag_time(time), clock_);
  tf_.transforms.front().header.stamp = time;
  to_ros(state, tf_.transforms.front().transform);
  bag_.write(tf_number_, to_bag_time(time), tf_);
  joints_.header.stamp = time;
  to_ros(state, joints_);
  bag_.write(joints_number_, to_bag_time(time), joints_);
}

void BagLog::add(const Topic& topic, Logged& logged) {
  logged.stamp = topic.stamp;
  const ros::Time stamp = to_ros(topic.stamp);
  if (logged.is_odometry) {
    odometry_.header.stamp = stamp;
    to_ros(messages::read<messages::Odometry>(topic.values.data()), odometry_);
    bag_.write(logged.number, to_bag_time(stamp), odometry_);
  } else {
    logged.array.data = topic.values;
    bag_.write(logged.number, to_bag_time(stamp), logged.array);
  }
}

void BagLog::close() {
  bag_.close();
  if (!bag_.is_whole()) fail(describe_truncation(path_));
  // An incomplete bag with an index can be read.
  if (bag_.is_indexed() && std::rename(active_.c_str(), path_.c_str()) != 0) {
    fail(describe_open_failure(path_));
  }
}

}  // namespace quadcore::node
