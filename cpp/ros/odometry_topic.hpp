#pragma once

#include <nav_msgs/Odometry.h>

#include <array>
#include <string>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// The simulation's topic `odom` and the plugin that writes it.
class OdometryTopic {
 public:
  /// Throws InputError if the topic lacks a field that nav_msgs/Odometry has.
  explicit OdometryTopic(const Simulation& simulation);

  /// Whether the simulation has the topic; nothing else may be asked where it has not.
  bool exists() const { return index_ >= 0; }
  const Topic& in(const Simulation& simulation) const {
    return simulation.topics()[static_cast<std::size_t>(index_)];
  }
  /// Whether its plugin asks for tf.
  bool publishes_tf() const { return publishes_tf_; }

  /// Fills pose, twist and their covariances with what the topic says.
  void to_message(const Topic& topic, nav_msgs::Odometry& message) const;
  /// The same with what is true, in the same axes.
  void truth_to_message(const VehicleState& state, nav_msgs::Odometry& message) const;

 private:
  int index_;
  bool publishes_tf_ = false;
  bool twist_in_body_ = false;
  std::array<std::size_t, 17> columns_{};  ///< of the topic, where each number of a message stands
};

}  // namespace quadcore::node
