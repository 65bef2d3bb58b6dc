#pragma once

#include <ros/ros.h>

#include <optional>
#include <string>
#include <vector>

#include "clock.hpp"
#include "flight_thread.hpp"
#include "quadcore/document.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// What the node's private parameters say.
struct Settings {
  Document model;
  std::string description;              ///< the parameter that holds the model; "" = it is a file
  std::string world;                    ///< path; "" = Gazebo's empty world, which has a ground
  std::string name;                     ///< of the model, for its topic; "" = as the URDF says
  std::string log;                      ///< path of a CSV log; "" = none
  std::vector<std::string> log_topics;  ///< topics in it
  std::string drag;                     ///< the one effect that drags, or "all", "none"
  bool verbose = false;
  bool rotor_tf = false;  ///< send the rotors' links, too
  ClockRole clock = ClockRole::automatic;
  std::vector<std::string> ignore;         ///< what model and world are read without
  std::optional<double> real_time_factor;  ///< absent = what the world asks for
  SimulationOptions simulation;
  FlightSettings flight;
};

/// Reads the parameters. Throws InputError on an unknown name or a value of the wrong kind.
/// \param nh  where robot_description is looked for, then upwards; parameters are those of "~".
Settings read_settings(const ros::NodeHandle& nh);

}  // namespace quadcore::node
