#pragma once

#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "private_parameters.hpp"
#include "quadcore/plugin/document.hpp"
#include "quadcore/simulation.hpp"
#include "vehicle_frames.hpp"

namespace quadcore::node {

/// Parameters of the node that simulates a vehicle.
struct Plant {
  std::string model_path;           ///< "" = robot_description
  Document model;                   ///< after it was read
  std::string description;          ///< name of its parameter; "" = a file
  std::string folder;               ///< base of relative paths; "" = the node's working folder
  std::string world;                ///< path; "" = Gazebo's empty world, with a ground
  std::string name;                 ///< name of the model; "" = the URDF's
  FrameNames frames;                ///< names of tf frames
  std::string drag;                 ///< the active drag, or "all", "none"
  std::vector<std::string> ignore;  ///< names to ignore in model and world
  SimulationOptions simulation;
};

/// Reads the parameters of a plant, but not the model. Throws InputError if a value has the wrong
/// type.
Plant read_plant(PrivateParameters& parameters);
/// Reads the plant's model.
/// \param nh  namespace in which the search for robot_description starts
void read_description(const ros::NodeHandle& nh, Plant& plant);

/// Resolves a relative path from `folder`.
std::string resolve_path(std::string folder, const std::string& path);

/// Returns additional plugins for a model. A plugin may replace a property of the world.
using Guests = std::function<std::vector<PluginElement>(const Model&, World&)>;

/// Reads the world of a plant.
World read_world_of(const Plant& plant);
/// Makes the simulation of a plant.
Simulation make_simulation(const Plant& plant, World world, const Guests& guests);

/// Returns the name of the model in topics and services. Throws InputError if it is not valid.
std::string choose_model_name(const Plant& plant, const Model& model);
/// Returns the topic of commands: below the model's name, as in Gazebo.
std::string resolve_command_topic(const ros::NodeHandle& nh, const Plant& plant,
                                  const Model& model);

}  // namespace quadcore::node
