#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "flight_thread.hpp"
#include "gazebo_wrenches.hpp"
#include "sayer.hpp"

namespace quadcore::node {

/// gazebo_ros' services about what flies, as far as they have a meaning here, and its topic
/// set_model_state.
class GazeboServices {
 public:
  /// \param nh     of the queue that answers
  /// \param model  its name
  GazeboServices(ros::NodeHandle& nh, const std::string& model, FlightThread& flight,
                 GazeboWrenches& wrenches);

  const std::vector<ros::ServiceServer>& servers() const { return servers_; }

 private:
  template <class Service, class Act>
  void offer(const std::string& name, const Act& act);
  void offer_states();
  void offer_wrenches();
  void offer_properties();

  ros::NodeHandle& nh_;
  const std::string model_;
  FlightThread& flight_;
  GazeboWrenches& wrenches_;
  Sayer sayer_;
  std::vector<ros::ServiceServer> servers_;
  ros::Subscriber subscriber_;
};

}  // namespace quadcore::node
