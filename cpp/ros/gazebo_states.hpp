#pragma once

#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/ModelStates.h>
#include <ros/ros.h>

#include <string>

#include "gazebo_neighbours.hpp"
#include "kept_publisher.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Sends where model and links are, each step, as gazebo_ros does.
class GazeboStates {
 public:
  /// \param model  its name
  /// \param neighbours  others whose models are of the same world, to be told of in /gazebo, too;
  ///                    null = it is for somebody else to tell
  GazeboStates(ros::NodeHandle& nh, const Simulation& simulation, const std::string& model,
               const GazeboNeighbours* neighbours);
  void send(const Simulation& simulation);

 private:
  const GazeboNeighbours* const neighbours_;
  KeptPublisher<gazebo_msgs::ModelStates> model_publisher_, all_models_publisher_;
  KeptPublisher<gazebo_msgs::LinkStates> link_publisher_, all_links_publisher_;
  gazebo_msgs::ModelStates models_;  ///< the ground first, as Gazebo has it
  gazebo_msgs::LinkStates links_;
};

}  // namespace quadcore::node
