#include "broadcast.hpp"

#include <algorithm>
#include <cmath>

#include "no_delay.hpp"

namespace quadcore::node {
namespace {

constexpr const char* world_frame = "world";
constexpr const char* vehicle_frame = "drone";
constexpr std::size_t longest_path = 2000;  // poses
/// A variance of zero stands for "unknown" to some filters and is singular to others. Without
/// noise this is sent: a deviation of 1e-6.
constexpr double least_variance = 1e-12;

/// Where the odometry plugin's topic holds what; see odometry_plugin.cpp.
enum Field {
  kPosition = 0,
  kOrientation = 3,
  kLinear = 7,
  kAngular = 10,
  kPositionVariance = 13,
  kOrientationVariance,
  kLinearVariance,
  kAngularVariance
};

ros::Time to_ros(double time) { return ros::Time().fromSec(time); }

template <class Vector>
void set_vector(Vector& vector, const double* values) {
  vector.x = values[0];
  vector.y = values[1];
  vector.z = values[2];
}

void set_quaternion(geometry_msgs::Quaternion& quaternion, const double* xyzw) {
  set_vector(quaternion, xyzw);
  quaternion.w = xyzw[3];
}

/// A diagonal 6x6 covariance: three variances of translation, three of rotation.
template <class Matrix>
void set_covariance(Matrix& matrix, double translation, double rotation) {
  for (std::size_t i = 0; i < 6; ++i) {
    matrix[7 * i] = std::max(i < 3 ? translation : rotation, least_variance);
  }
}

bool publishes_tf(const Simulation& simulation) {
  return std::any_of(simulation.plugins().begin(), simulation.plugins().end(), [](const auto& p) {
    return p.filename == "libodometry_plugin.so" && p.parameters.flag("publishTf");
  });
}

}  // namespace

bool ThinnedTopic::due(double time, bool jumped) {
  const double count = std::floor(time * rate_ + 1e-6);
  if (count == last_ && !jumped) return false;
  last_ = count;
  return publisher.getNumSubscribers() > 0;
}

Broadcast::Broadcast(ros::NodeHandle& nh, const Simulation& simulation, bool keep_last)
    : odometry_topic_(simulation.topics().find("odom")) {
  const ros::SubscriberStatusCallback no_delay = [](const ros::SingleSubscriberPublisher&) {
    send_without_delay();
  };
  clock_publisher_ = nh.advertise<rosgraph_msgs::Clock>("/clock", 1000, no_delay);
  joint_states_topic_.publisher =
      nh.advertise<sensor_msgs::JointState>("joint_states", 100, no_delay);
  path_topic_.publisher = nh.advertise<nav_msgs::Path>("path", 10, no_delay);
  const Model& model = simulation.model();
  joint_states_.name = model.joint_names();
  path_.header.frame_id = world_frame;
  if (odometry_topic_ < 0) {
    ROS_WARN("the model has no libodometry_plugin.so: odom and tf are not sent");
    return;
  }
  odometry_publisher_ = nh.advertise<nav_msgs::Odometry>("odom", 1000, no_delay, {}, {}, keep_last);
  odometry_.header.frame_id = transform_.header.frame_id = world_frame;
  odometry_.child_frame_id = transform_.child_frame_id = vehicle_frame;
  publish_tf_ = publishes_tf(simulation);
  const std::string& root = model.links.front().name;
  if (publish_tf_ && root != vehicle_frame) {
    // robot_state_publisher begins at the URDF's root link, tf at the thesis' "drone".
    geometry_msgs::TransformStamped same;
    same.header.frame_id = vehicle_frame;
    same.child_frame_id = root;
    same.transform.rotation.w = 1;
    static_tf_.sendTransform(same);
  }
}

void Broadcast::send(const Simulation& simulation, bool jumped) {
  clock_.clock = to_ros(simulation.time());
  clock_publisher_.publish(clock_);
  if (odometry_topic_ >= 0) {
    const Topic& topic = simulation.topics()[static_cast<std::size_t>(odometry_topic_)];
    if (topic.count > 0 && (topic.count != sent_ || jumped)) send_odometry(topic);
  }
  if (jumped) path_.poses.clear();
  if (joint_states_topic_.due(simulation.time(), jumped)) send_joint_states(simulation);
  if (path_topic_.due(simulation.time(), jumped)) send_path(simulation);
}

void Broadcast::send_odometry(const Topic& topic) {
  sent_ = topic.count;
  const double* values = topic.values.data();
  odometry_.header.stamp = to_ros(topic.stamp);
  set_vector(odometry_.pose.pose.position, values + kPosition);
  set_quaternion(odometry_.pose.pose.orientation, values + kOrientation);
  set_covariance(odometry_.pose.covariance, values[kPositionVariance],
                 values[kOrientationVariance]);
  set_vector(odometry_.twist.twist.linear, values + kLinear);
  set_vector(odometry_.twist.twist.angular, values + kAngular);
  set_covariance(odometry_.twist.covariance, values[kLinearVariance], values[kAngularVariance]);
  odometry_publisher_.publish(odometry_);
  if (!publish_tf_) return;
  transform_.header.stamp = odometry_.header.stamp;
  set_vector(transform_.transform.translation, values + kPosition);
  transform_.transform.rotation = odometry_.pose.pose.orientation;
  tf_.sendTransform(transform_);
}

void Broadcast::send_joint_states(const Simulation& simulation) {
  const VehicleState& state = simulation.state();
  const auto assign = [](std::vector<double>& to, const VectorXd& from) {
    to.assign(from.data(), from.data() + from.size());
  };
  joint_states_.header.stamp = clock_.clock;
  assign(joint_states_.position, state.rotor_angle);
  assign(joint_states_.velocity, state.rotor_velocity);
  joint_states_topic_.publisher.publish(joint_states_);
}

void Broadcast::send_path(const Simulation& simulation) {
  const VehicleState& state = simulation.state();
  geometry_msgs::PoseStamped pose;
  pose.header.stamp = clock_.clock;
  pose.header.frame_id = world_frame;
  set_vector(pose.pose.position, state.position.data());
  set_quaternion(pose.pose.orientation, state.orientation.coeffs().data());
  if (path_.poses.size() == longest_path) path_.poses.erase(path_.poses.begin());
  path_.poses.push_back(pose);
  path_.header.stamp = clock_.clock;
  path_topic_.publisher.publish(path_);
}

}  // namespace quadcore::node
