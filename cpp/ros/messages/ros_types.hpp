#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/topics.hpp"

/// \file
/// Topics of the simulation as topics of ROS: which type carries which kind of message.

namespace quadcore::node {

/// A topic of the simulation on its way out.
class Outlet {
 public:
  virtual ~Outlet() = default;
  virtual void send(const Topic& topic, const ros::Time& stamp) = 0;
};

/// What is done with the numbers that come in.
using Take = std::function<void(const std::vector<double>&)>;

/// Throws InputError if the node has a topic of that name already.
void check_free(ros::NodeHandle& nh, const std::string& name);
/// Advertises a topic under its own name.
/// \param frame  tf's name of what its numbers are in, or of the vehicle that an odometry is of
std::unique_ptr<Outlet> make_outlet(ros::NodeHandle& nh, const Topic& topic,
                                    const std::string& frame);
/// Subscribes to a topic under its own name; `take` runs where the callbacks of `nh` do.
/// Throws InputError if the node has a topic of that name already, or no type of ROS holds it.
ros::Subscriber make_inlet(ros::NodeHandle& nh, const Topic& topic, const Take& take);

/// Says that an array has so many numbers more, and what they are called.
void add_dimension(std_msgs::Float64MultiArray& array, const std::string& label, std::size_t size);
/// Names the frames of an odometry message.
void set_frames(nav_msgs::Odometry& message, const std::string& vehicle_frame);
/// Fills pose, twist and their covariances. A variance of 0 becomes the least that filters bear.
void to_ros(const messages::Odometry& odometry, nav_msgs::Odometry& message);
messages::Odometry from_ros(const nav_msgs::Odometry& message);

}  // namespace quadcore::node
