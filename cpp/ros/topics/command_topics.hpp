#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "plant.hpp"

namespace quadcore::node {

/// A topic of ROS on which commands come, each of them rotor speeds.
struct CommandTopic {
  std::string name;        ///< resolved
  std::string simulated;   ///< the simulation's topic that they go to
  bool actuators = false;  ///< in RotorS' mav_msgs/Actuators; else in the thesis' type
  bool sent_too = false;   ///< this node publishes it, too
};

/// Where commands for a vehicle come in, the thesis' topic first. Call once all that the node
/// publishes is advertised.
std::vector<CommandTopic> command_topics(const ros::NodeHandle& nh, const Plant& plant,
                                         const Simulation& simulation);
/// Of how many nodes commands may come.
std::size_t commanders(const std::vector<CommandTopic>& topics);
/// What of the simulation commands go to.
std::vector<std::string> simulated(const std::vector<CommandTopic>& topics);
/// Their names, for a person.
std::string described(const std::vector<CommandTopic>& topics);

}  // namespace quadcore::node
