#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <optional>
#include <string>

#include "gazebo_states.hpp"
#include "kept_publisher.hpp"
#include "odometry_topic.hpp"
#include "offering_publisher.hpp"
#include "path.hpp"
#include "quadcore/simulation.hpp"
#include "thinned.hpp"
#include "topic_broadcast.hpp"

namespace quadcore::node {

/// Sends what the original package sends: /clock each step, then odom and tf world->drone with each
/// message of the odometry plugin; besides, ground_truth/odometry, joint_states, path for rviz, and
/// every other topic of the plugins, ahead of the odometry that somebody may answer.
/// Stamps are simulation time, those of odom among the values of /clock. The last message of all is
/// kept for those who subscribe later, so that a paused flight is seen, too.
class Broadcast {
 public:
  /// \param clock  where the clock is sent; an empty publisher = somebody else sends it
  /// \param frame_prefix  of the vehicle's frames, "" or such as "uav1/"
  /// \param rotor_tf  whether tf holds the rotors' links, too. What robot_state_publisher sends of
  ///                  them is not kept for those who come later.
  Broadcast(ros::NodeHandle& nh, const Simulation& simulation,
            const KeptPublisher<rosgraph_msgs::Clock>& clock, const std::string& frame_prefix,
            GazeboStates& gazebo_states, bool rotor_tf);

  /// After a step; `jumped`: after the start, a reset or a new state.
  void send(const Simulation& simulation, bool jumped);
  /// Sends what is there to see, but nothing of the plugins, which somebody might answer.
  void show(const Simulation& simulation);
  /// Sends the odometry of now to those who have waited for some for long.
  void offer(const Simulation& simulation);

 private:
  void advertise_odometry(ros::NodeHandle& nh, const std::string& frame_prefix,
                          const Simulation& simulation, bool rotor_tf);
  void send_static_frames(ros::NodeHandle& nh, const Model& model, const std::string& frame_prefix);
  void send_odometry(const Simulation& simulation, const Topic& topic);
  void fill_odometry(const Topic& topic);
  void send_truth(const VehicleState& state);
  void add_rotor_frames(const Model& model, const std::string& frame_prefix);
  void send_transforms(const Simulation& simulation);
  void send_joint_states(const VehicleState& state);

  const OdometryTopic odometry_topic_;
  double sent_ = 0;  ///< count of the odometry message that was sent last
  Thinned joint_states_due_{50};

  KeptPublisher<rosgraph_msgs::Clock> clock_publisher_;
  OfferingPublisher<nav_msgs::Odometry> odometry_publisher_;
  ros::Publisher truth_publisher_;
  ros::Publisher tf_publisher_;
  ros::Publisher static_tf_publisher_;
  ros::Publisher joint_states_publisher_;
  PathTopic path_;
  GazeboStates& gazebo_states_;
  std::optional<TopicBroadcast> others_;

  // Kept, so that sending them needs no new memory.
  rosgraph_msgs::Clock clock_;
  nav_msgs::Odometry odometry_;
  nav_msgs::Odometry truth_;
  tf2_msgs::TFMessage transforms_;  ///< world->drone, then those of the rotors
  sensor_msgs::JointState joint_states_;
};

}  // namespace quadcore::node
