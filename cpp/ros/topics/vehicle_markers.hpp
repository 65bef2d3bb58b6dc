#pragma once

#include <ros/ros.h>

#include <string>

#include "frames.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Publishes vehicle_markers once, latched: the drawing of `quadcore info --picture` in the frames
/// of tf. Namespaces are `discs`, `spins` (in hover, for rotors that a plugin drives), `numbers`,
/// `boxes` and `masses`, of links and rotors, and `centre_of_mass`.
class VehicleMarkers {
 public:
  VehicleMarkers(ros::NodeHandle& nh, Simulation& simulation, const Frames& frames);

 private:
  ros::Publisher publisher_;
};

}  // namespace quadcore::node
