#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "plant.hpp"

namespace quadcore::node {

/// A ROS topic for commands, which are rotor speeds.
struct CommandTopic {
  std::string name;        ///< resolved
  std::string simulated;   ///< topic of the simulation
  bool actuators = false;  ///< type mav_msgs/Actuators of RotorS; otherwise the thesis' type
  bool sent_too = false;   ///< this node also publishes it
};

/// Returns the topics for commands to a vehicle, the thesis' topic first. Call after the node has
/// advertised all topics.
std::vector<CommandTopic> find_command_topics(const ros::NodeHandle& nh, const Plant& plant,
                                              const Simulation& simulation);
/// Returns the number of nodes that may send commands.
std::size_t count_commanders(const std::vector<CommandTopic>& topics);
/// Returns the topics of the simulation that receive commands.
std::vector<std::string> list_simulated(const std::vector<CommandTopic>& topics);
/// Joins the names of the topics for messages.
std::string join_names(const std::vector<CommandTopic>& topics);

}  // namespace quadcore::node
