#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <string>
#include <vector>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Gazebo's services to pause and reset, quadcore's to step, to set the state, and to say something
/// to plugins. They answer in threads of their own, so that one that takes long holds up neither
/// commands nor the others.
class Services {
 public:
  /// \param own_clock  whether a reset of the simulation sets the clock back; else time goes on
  Services(ros::NodeHandle nh, const Simulation& simulation, FlightThread& flight, bool own_clock);

  /// Resolved names.
  std::vector<std::string> names() const;

 private:
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace quadcore::node
