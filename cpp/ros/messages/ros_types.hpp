#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "frames.hpp"
#include "quadcore/plugin/topics.hpp"

/// \file
/// Topics of the simulation as ROS topics, with a ROS type for each kind of message.

namespace quadcore::node {

/// Publishes a topic of the simulation in ROS.
class Outlet {
 public:
  virtual ~Outlet() = default;
  virtual void send(const Topic& topic, const ros::Time& stamp) = 0;
};

/// Callback for received numbers.
using Take = std::function<void(const std::vector<double>&)>;

/// Throws InputError if the node already has a topic of that name.
void check_name_is_free(ros::NodeHandle& nh, const std::string& name);
/// Advertises a topic under its own name.
std::unique_ptr<Outlet> make_outlet(ros::NodeHandle& nh, const Topic& topic,
                                    const MessageFrames& frames);
/// Subscribes to a topic under its own name; `take` runs in the callback thread of `nh`.
/// Throws InputError if the node already has a topic of that name, or if no ROS type contains it.
ros::Subscriber make_inlet(ros::NodeHandle& nh, const Topic& topic, const Take& take);

/// Adds a dimension to an array, with its size and label.
void add_dimension(std_msgs::Float64MultiArray& array, const std::string& label, std::size_t size);
/// Sets the frames of an odometry message.
void set_frames(nav_msgs::Odometry& message, const MessageFrames& frames);
/// Fills pose, twist and their covariances. A variance of 0 becomes the minimum variance.
void to_ros(const messages::Odometry& odometry, nav_msgs::Odometry& message);
messages::Odometry from_ros(const nav_msgs::Odometry& message);

}  // namespace quadcore::node
