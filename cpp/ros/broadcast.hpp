#pragma once

#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// A topic for something that is worth sending less often than each step.
class ThinnedTopic {
 public:
  explicit ThinnedTopic(double rate) : rate_(rate) {}

  /// Whether a message is due at `time`, the first after a jump at once.
  bool due(double time, bool jumped);

  ros::Publisher publisher;

 private:
  double rate_;  // 1/s
  double last_ = -1;
};

/// Sends what the original package sends: /clock each step, then odom and tf world->drone with each
/// message of the odometry plugin; besides, joint_states and path for rviz. Stamps are simulation
/// time, those of odom among the values of /clock.
class Broadcast {
 public:
  /// \param keep_last  whether odom is kept for subscribers that come later; in lockstep a
  ///                   controller must not miss the message that the plant waits on.
  Broadcast(ros::NodeHandle& nh, const Simulation& simulation, bool keep_last);

  /// After a step; `jumped`: after the start, a reset or a new state.
  void send(const Simulation& simulation, bool jumped);

 private:
  void send_odometry(const Topic& topic);
  void send_joint_states(const Simulation& simulation);
  void send_path(const Simulation& simulation);

  const int odometry_topic_;
  bool publish_tf_ = false;
  double sent_ = 0;  ///< count of the odometry message that was sent last

  ros::Publisher clock_publisher_;
  ros::Publisher odometry_publisher_;
  ThinnedTopic joint_states_topic_{50};
  ThinnedTopic path_topic_{10};
  tf2_ros::TransformBroadcaster tf_;
  tf2_ros::StaticTransformBroadcaster static_tf_;

  // Kept, so that sending them needs no new memory.
  rosgraph_msgs::Clock clock_;
  nav_msgs::Odometry odometry_;
  geometry_msgs::TransformStamped transform_;
  sensor_msgs::JointState joint_states_;
  nav_msgs::Path path_;
};

}  // namespace quadcore::node
