#pragma once

#include <ros/ros.h>

#include <string>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Sends vehicle_markers once, for who comes later, too: what `quadcore info --picture` draws, in
/// the frames of tf. Namespaces are `discs`, `spins` (in hover; none where nothing drives a rotor),
/// `numbers`, `boxes` and `masses`, of links and rotors, and `centre_of_mass`.
class VehicleMarkers {
 public:
  /// \param frame_prefix  of the vehicle's frames, "" or such as "uav1/"
  VehicleMarkers(ros::NodeHandle& nh, Simulation& simulation, const std::string& frame_prefix);

 private:
  ros::Publisher publisher_;
};

}  // namespace quadcore::node
