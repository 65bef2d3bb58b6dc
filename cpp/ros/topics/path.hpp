#pragma once

#include <nav_msgs/Path.h>
#include <ros/ros.h>

#include "message_rate.hpp"
#include "quadcore/state.hpp"

namespace quadcore::node {

/// Publishes the path of the vehicle for rviz.
class PathTopic {
 public:
  PathTopic(ros::NodeHandle& nh, const std::string& frame);

  /// Call after a step that ended at `stamp`; a jump begins a new path.
  void add(const VehicleState& state, const ros::Time& stamp, bool jumped);

 private:
  MessageRate due_{10};
  ros::Publisher publisher_;
  nav_msgs::Path path_;
};

}  // namespace quadcore::node
