#pragma once

#include <ros/ros.h>

#include <optional>
#include <string>
#include <vector>

#include "clock.hpp"
#include "flight_thread.hpp"
#include "plant.hpp"

namespace quadcore::node {

/// What the node's private parameters say.
struct Settings {
  Plant plant;
  std::string log;                      ///< path of a log; "" = none
  std::vector<std::string> log_topics;  ///< topics in it
  bool verbose = false;
  bool rotor_tf = false;  ///< send the rotors' links, too
  ClockRole clock = ClockRole::automatic;
  std::optional<double> real_time_factor;  ///< absent = what the world asks for
  FlightSettings flight;
};

/// Reads the parameters. Throws InputError on an unknown name or a value of the wrong kind.
/// \param nh  where robot_description is looked for, then upwards; parameters are those of "~".
Settings read_settings(const ros::NodeHandle& nh);

}  // namespace quadcore::node
