#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "bag_file.hpp"
#include "flight_log.hpp"
#include "message_rate.hpp"
#include "vehicle_messages.hpp"

namespace quadcore::node {

/// A bag with a row of the log and the true odometry after each step, and with each message of the
/// logged topics. Clock, tf and joint states have the rate of the node's joint states, because a
/// bag with each of them would be twice as large. Like with `rosbag record`, it is called
/// FILE.bag.active while it grows. An older file remains until then.
class BagLog final : public FlightLog {
 public:
  /// Throws InputError if the file cannot be written.
  BagLog(const std::string& path, const Simulation& simulation, LogRow row,
         const ros::NodeHandle& nh, const Frames& frames);
  void add(const Simulation& simulation) override;
  void close() override;

 private:
  /// A topic of the simulation.
  struct Logged {
    std::size_t index;     ///< index in the simulation
    std::uint32_t number;  ///< number in the bag
    bool is_odometry;      ///< else an array
    double stamp;          ///< stamp of the last message
    std_msgs::Float64MultiArray array;
  };
  void add_truth(const VehicleState& state, const ros::Time& time);
  /// Adds what does not come with each row.
  void add_slow(const VehicleState& state, const ros::Time& time);
  void add(const Topic& topic, Logged& logged);

  const std::string path_, active_;
  LogRow row_;
  BagFile bag_;
  std::uint32_t clock_number_, truth_number_, tf_number_, joints_number_, row_number_;
  std::vector<Logged> topics_;
  MessageRate slow_rate_{joint_states_rate};
  // Stored to reuse their memory.
  rosgraph_msgs::Clock clock_;
  nav_msgs::Odometry odometry_;
  tf2_msgs::TFMessage tf_;
  sensor_msgs::JointState joints_;
  std_msgs::Float64MultiArray whole_row_;
};

}  // namespace quadcore::node
