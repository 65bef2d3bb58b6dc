#pragma once

#include <memory>
#include <string>

#include "controller_setup.hpp"
#include "plant.hpp"
#include "plant_watch.hpp"

namespace quadcore::node {

/// What the parameters of a controller's node say.
struct ControllerSettings {
  control::ControllerSetup setup;
  std::shared_ptr<const control::ReferenceShape> reference;  ///< null without one
  double velocity_timeout;                                   ///< of the topic command/velocity [s]
  VehicleDescription vehicle;
  double dt;                  ///< of the plant [s]
  bool lockstep;              ///< whether the plant waits for an answer to each odometry message
  std::string command_topic;  ///< of the plant
  PlantWatch plant;           ///< begun before it was read
};

/// Reads the private parameters: those of libcontroller_plugin.so but for its topics, `reference`,
/// a shape or a dictionary of the tags of libreference_plugin.so, `plant`, the node that flies the
/// vehicle, which is what the law believes to fly, and `velocity_timeout`.
/// Throws InputError on an unknown name or a value that cannot be flown.
ControllerSettings read_controller_settings(const ros::NodeHandle& nh);

}  // namespace quadcore::node
