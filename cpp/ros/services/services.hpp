#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <optional>
#include <string>
#include <vector>

#include "flight_thread.hpp"
#include "gazebo_services.hpp"

namespace quadcore::node {

/// Gazebo's services to pause and reset, and quadcore's to step, to set the state, and to publish
/// to plugins. They run in their own threads, so a long call delays neither commands nor other
/// services.
class Services {
 public:
  /// \param neighbours  who fly by this vehicle's clock, null = it follows itself: a leader answers
  /// in
  ///                    /gazebo for all, and, without a namespace, a reset sets the clock back
  /// \param model  its name
  Services(const ros::NodeHandle& nh, const Simulation& simulation, FlightThread& flight,
           const std::string& model, GazeboWrenches& wrenches, const GazeboNeighbours* neighbours);

  /// Returns the resolved names of all services.
  std::vector<std::string> names() const;

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  std::vector<ros::ServiceServer> servers_;
  std::optional<GazeboServices> gazebo_;
  ros::AsyncSpinner spinner_;
};

}  // namespace quadcore::node
