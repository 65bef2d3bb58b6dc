#pragma once

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// The simulation's topic `odom` and the options of the plugin that publishes it.
class OdometryTopic {
 public:
  static constexpr const char* name = "odom";

  explicit OdometryTopic(const Simulation& simulation);

  /// Whether the simulation has the topic. Otherwise, do not call other members.
  bool exists() const { return index_ >= 0; }
  const Topic& in(const Simulation& simulation) const {
    return simulation.topics()[static_cast<std::size_t>(index_)];
  }
  /// Returns the number of messages so far.
  double count(const Simulation& simulation) const { return exists() ? in(simulation).count : 0; }
  /// Whether its plugin publishes tf.
  bool publishes_tf() const { return publishes_tf_; }
  /// Returns the true state in the same axes.
  messages::Odometry truth(const VehicleState& state) const;

 private:
  int index_ = -1;
  bool publishes_tf_ = false;
  bool twist_in_body_ = false;
};

}  // namespace quadcore::node
