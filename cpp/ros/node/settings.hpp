#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clock.hpp"
#include "flight_thread.hpp"
#include "plant.hpp"

namespace quadcore::node {

/// Values of the node's private parameters.
struct Settings {
  Plant plant;
  std::string log;                             ///< path of the log; "" = no log
  std::vector<std::string> log_topics;         ///< topics in the log
  std::int64_t log_every = 1;                  ///< steps per row of the log
  std::map<std::string, double> joint_angles;  ///< at the start, by joint [rad]
  bool verbose = false;
  bool rotor_tf = false;  ///< also send the rotors' links
  ClockRole clock = ClockRole::automatic;
  double clock_rate = 0;  ///< messages on /clock per second of simulation time; 0 = each step
  std::optional<double> real_time_factor;  ///< absent = the world's value
  FlightSettings flight;
};

/// Reads the parameters. Throws InputError on an unknown name or a value of the wrong kind.
/// \param nh  namespace in which the search for robot_description starts; parameters are those of
/// "~".
Settings read_settings(const ros::NodeHandle& nh);

}  // namespace quadcore::node
