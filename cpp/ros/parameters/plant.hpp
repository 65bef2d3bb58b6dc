#pragma once

#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "private_parameters.hpp"
#include "quadcore/plugin/document.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// What flies, as the parameters of the node that flies it say.
struct Plant {
  std::string model_path;           ///< "" = robot_description
  Document model;                   ///< once it is read
  std::string description;          ///< the parameter that holds it; "" = it is a file
  std::string folder;               ///< where relative paths begin; "" = where the node was started
  std::string world;                ///< path; "" = Gazebo's empty world, which has a ground
  std::string name;                 ///< of the model, for its topics; "" = as the URDF says
  std::string drag;                 ///< the one effect that drags, or "all", "none"
  std::vector<std::string> ignore;  ///< what model and world are read without
  SimulationOptions simulation;
};

/// Reads the parameters of a plant, but not yet the model.
/// Throws InputError on a value of the wrong kind.
Plant read_plant(PrivateParameters& parameters);
/// Reads the plant's model.
/// \param nh  where robot_description is looked for, then upwards
void read_description(const ros::NodeHandle& nh, Plant& plant);

/// A path that, if relative, is meant from `folder`.
std::string path_from(std::string folder, const std::string& path);

/// Plugins besides a model's own.
using Guests = std::function<std::vector<PluginElement>(const Model&)>;

/// The world that was asked for.
World read_world_of(const Plant& plant);
/// The simulation that was asked for.
Simulation make_simulation(const Plant& plant, const World& world, const Guests& guests);

/// What the model is called in topics and services. Throws InputError on a name that cannot be one.
std::string model_name(const Plant& plant, const Model& model);
/// Where commands come in: below the model's name, as Gazebo has it.
std::string command_topic(const ros::NodeHandle& nh, const Plant& plant, const Model& model);
/// What a vehicle's frames begin with: "uav1/" in the namespace uav1.
std::string frame_prefix(const ros::NodeHandle& nh);
/// tf's name of a link; RotorS' links have the namespace in their names already.
std::string frame_of(const std::string& prefix, const std::string& link);

}  // namespace quadcore::node
