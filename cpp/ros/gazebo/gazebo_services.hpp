#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "flight_thread.hpp"
#include "gazebo_neighbours.hpp"
#include "gazebo_wrenches.hpp"
#include "warning_limiter.hpp"

namespace quadcore::node {

/// The services of gazebo_ros about models, as far as they have a meaning here, and its topic
/// set_model_state.
class GazeboServices {
 public:
  /// \param nh     node handle with the services' queue
  /// \param model  name of the model
  /// \param neighbours  neighbours with models that are also served in /gazebo; null = another node
  /// serves /gazebo
  GazeboServices(ros::NodeHandle& nh, const std::string& model, FlightThread& flight,
                 GazeboWrenches& wrenches, const GazeboNeighbours* neighbours);

  const std::vector<ros::ServiceServer>& servers() const { return servers_; }

 private:
  template <class Service, class Act>
  void offer(const std::string& name, const Act& act);
  void take_states(const std::string& topic);
  void offer_states();
  void offer_wrenches();
  void offer_properties();

  ros::NodeHandle& nh_;
  const std::string model_;
  FlightThread& flight_;
  GazeboWrenches& wrenches_;
  const GazeboNeighbours* const neighbours_;
  WarningLimiter limiter_;
  std::vector<ros::ServiceServer> servers_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace quadcore::node
