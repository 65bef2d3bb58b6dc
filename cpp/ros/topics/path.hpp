#pragma once

#include <nav_msgs/Path.h>
#include <ros/ros.h>

#include "quadcore/state.hpp"
#include "thinned.hpp"

namespace quadcore::node {

/// Where the vehicle has been, for rviz.
class PathTopic {
 public:
  explicit PathTopic(ros::NodeHandle& nh);

  /// A step has ended at `stamp`; a jump begins a new path.
  void add(const VehicleState& state, const ros::Time& stamp, bool jumped);

 private:
  Thinned due_{10};
  ros::Publisher publisher_;
  nav_msgs::Path path_;
};

}  // namespace quadcore::node
