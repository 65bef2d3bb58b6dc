#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <quadcore/AttitudeThrust.h>
#include <quadcore/RateThrust.h>
#include <ros/ros.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <string>
#include <vector>

#include "active_aim.hpp"
#include "warning_limiter.hpp"

namespace quadcore::node {

/// Receives set points on topics `command/...`. Invalid messages are rejected and reported.
class SetPoints {
 public:
  /// \param frame  the only frame of poses; an empty one in a message is the same
  /// \param velocity_timeout  time after which a velocity ends in a hover [s]
  SetPoints(ros::NodeHandle& nh, std::string frame, double velocity_timeout, ActiveAim& active_aim);

 private:
  template <class Message>
  void take(ros::NodeHandle& nh, const std::string& topic,
            void (SetPoints::*act)(const Message& message));

  void pose(const geometry_msgs::PoseStamped& message);
  void trajectory(const trajectory_msgs::MultiDOFJointTrajectory& message);
  void velocity(const geometry_msgs::Twist& message);
  void attitude(const AttitudeThrust& message);
  void rates(const RateThrust& message);

  /// Throws InputError for another frame.
  void check_frame(const std_msgs::Header& header) const;

  const std::string frame_;
  double velocity_timeout_;
  ActiveAim& active_aim_;
  WarningLimiter limiter_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace quadcore::node
