#pragma once

#include <memory>
#include <string>

#include "controller_setup.hpp"
#include "plant.hpp"
#include "plant_watch.hpp"

namespace quadcore::node {

/// Parameters of a controller node.
struct ControllerSettings {
  control::ControllerSetup setup;
  std::shared_ptr<const control::ReferenceShape> reference;  ///< null = no reference
  double velocity_timeout;  ///< timeout of the topic command/velocity [s]
  VehicleDescription vehicle;
  double dt;                  ///< step topic of the plant [s]
  bool lockstep;              ///< whether the plant waits for an answer to each odometry message
  std::string command_topic;  ///< of the plant
  Frames frames;              ///< of the plant
  PlantWatch plant;           ///< constructed before the parameters were read
};

/// Reads the private parameters: those of libcontroller_plugin.so without its topics, `reference`
/// (a shape, or a dictionary of the tags of libreference_plugin.so), `plant` (the node with the
/// vehicle that the controller uses as its model), and `velocity_timeout`. Throws InputError if a
/// name is unknown or a value is not valid.
ControllerSettings read_controller_settings(const ros::NodeHandle& nh);

}  // namespace quadcore::node
