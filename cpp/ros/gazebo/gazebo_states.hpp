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

/// Sends where model and links are, each step, as gazebo_ros does; to nobody, no work is done.
class GazeboStates {
 public:
  /// \param model  its name
  /// \param neighbours  others whose models are of the same world, to be told of in /gazebo, too;
  ///                    null = it is for somebody else to tell
  GazeboStates(ros::NodeHandle& nh, const Simulation& simulation, const std::string& model,
               const GazeboNeighbours* neighbours);
  void send(const Simulation& simulation);
  /// What is done when somebody subscribes, who may see a flight that is paused.
  void for_newcomers(const std::function<void()>& action);
  /// Whether anyone wants to know of the neighbours.
  bool asks_neighbours() const;

 private:
  template <class States>
  struct Sent {
    ros::Publisher own, of_all;
    States states;  ///< the ground first, as Gazebo has it
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
