#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <quadcore/AttitudeThrust.h>
#include <quadcore/RateThrust.h>
#include <ros/ros.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <string>
#include <vector>

#include "guide.hpp"
#include "sayer.hpp"

namespace quadcore::node {

/// Takes what a vehicle is asked for on topics `command/...`. A message that makes no sense is
/// refused and reported.
class SetPoints {
 public:
  /// \param velocity_timeout  after which a velocity without another one ends in a hover [s]
  SetPoints(ros::NodeHandle& nh, double velocity_timeout, Guide& guide);

 private:
  template <class Message>
  void take(ros::NodeHandle& nh, const std::string& topic,
            void (SetPoints::*act)(const Message& message));

  void pose(const geometry_msgs::PoseStamped& message);
  void trajectory(const trajectory_msgs::MultiDOFJointTrajectory& message);
  void velocity(const geometry_msgs::Twist& message);
  void attitude(const AttitudeThrust& message);
  void rates(const RateThrust& message);

  double velocity_timeout_;
  Guide& guide_;
  Sayer sayer_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace quadcore::node
