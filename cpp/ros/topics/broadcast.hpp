#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <optional>
#include <string>

#include "clock_publisher.hpp"
#include "gazebo_states.hpp"
#include "latched_publisher.hpp"
#include "message_rate.hpp"
#include "odometry_topic.hpp"
#include "offering_publisher.hpp"
#include "path.hpp"
#include "quadcore/simulation.hpp"
#include "topic_broadcast.hpp"
#include "transform_publisher.hpp"
#include "vehicle_messages.hpp"

namespace quadcore::node {

/// Publishes the topics of the original package: /clock, by default each step, and odom and tf
/// world->drone with each message of the odometry plugin. It also publishes ground_truth/odometry,
/// joint_states, path for rviz, and every other topic of the plugins, before the odometry that a
/// node may answer. Stamps are simulation time; those of odom are values of /clock. Topics are
/// latched, so a paused flight is visible.
class Broadcast {
 public:
  /// \param clock  publisher of the clock; empty = another node publishes it
  /// \param rotor_tf  whether tf also contains the rotors' links. Those of robot_state_publisher
  /// are not latched.
  Broadcast(ros::NodeHandle& nh, const Simulation& simulation, const ClockPublisher& clock,
            const Frames& frames, GazeboStates& gazebo_states, bool rotor_tf);

  /// Call after a step; `jumped`: after the start, a reset or a new state.
  void send(const Simulation& simulation, bool jumped);
  /// Publishes the state, but no messages of plugins, which a node might answer.
  void show(const Simulation& simulation);
  /// Sends the present odometry to subscribers that have waited for some seconds.
  void offer(const Simulation& simulation);
  /// Whether to call serve_new_subscribers() between two steps.
  bool has_unserved_subscriber() const { return tf_publisher_.has_unserved_subscriber(); }
  /// Sends the present transforms if a new subscriber may have missed them.
  void serve_new_subscribers(const Simulation& simulation);

 private:
  void advertise_odometry(ros::NodeHandle& nh, const Frames& frames, const Simulation& simulation,
                          bool rotor_tf);
  void send_static_frames(ros::NodeHandle& nh, const Model& model, const Frames& frames);
  void send_odometry(const Simulation& simulation, const Topic& topic);
  void fill_odometry(const Topic& topic);
  void send_truth(const VehicleState& state);
  void add_rotor_frames(const Model& model, const Frames& frames);
  void send_transforms(const Simulation& simulation);
  void send_joint_states(const VehicleState& state);

  const OdometryTopic odometry_topic_;
  double sent_ = 0;  ///< count of the last odometry message sent
  MessageRate joint_states_due_{joint_states_rate};

  ClockPublisher clock_publisher_;
  OfferingPublisher<nav_msgs::Odometry> odometry_publisher_;
  ros::Publisher truth_publisher_;
  TransformPublisher tf_publisher_;
  ros::Publisher static_tf_publisher_;
  ros::Publisher joint_states_publisher_;
  PathTopic path_;
  GazeboStates& gazebo_states_;
  std::optional<TopicBroadcast> others_;

  // Stored to reuse their memory.
  rosgraph_msgs::Clock clock_;
  nav_msgs::Odometry odometry_;
  nav_msgs::Odometry truth_;
  tf2_msgs::TFMessage transforms_;  ///< the vehicle in the world, then the rotors
  sensor_msgs::JointState joint_states_;
};

}  // namespace quadcore::node
