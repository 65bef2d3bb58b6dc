#pragma once

#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/ModelStates.h>
#include <ros/ros.h>

#include <functional>
#include <mutex>
#include <string>

#include "gazebo_neighbours.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Publishes the states of model and links in each step, like gazebo_ros. Without subscribers, it
/// computes nothing.
class GazeboStates {
 public:
  /// \param model  name of the model
  /// \param neighbours  neighbours with models that are also published in /gazebo; null = another
  /// node publishes there
  GazeboStates(ros::NodeHandle& nh, const Simulation& simulation, const std::string& model,
               const GazeboNeighbours* neighbours);
  void send(const Simulation& simulation);
  /// Sets an action for new subscribers, for example during a pause.
  void for_newcomers(const std::function<void()>& action);
  /// Whether a subscriber needs the neighbours' states.
  bool asks_neighbours() const;

 private:
  template <class States>
  struct Sent {
    ros::Publisher own, of_all;
    States states;  ///< the ground first, as in Gazebo
  };
  template <class States>
  void advertise(ros::NodeHandle& nh, const std::string& name, Sent<States>& sent);
  template <class States>
  void publish(Sent<States>& sent);

  const GazeboNeighbours* const neighbours_;
  std::mutex mutex_;
  std::function<void()> for_newcomers_;
  Sent<gazebo_msgs::ModelStates> models_;
  Sent<gazebo_msgs::LinkStates> links_;
};

}  // namespace quadcore::node
