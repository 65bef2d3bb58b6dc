#pragma once

#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"
#include "ros_types.hpp"

namespace quadcore::node {

/// Publishes the topics of plugins, each under its own name in the type of its kind.
class TopicBroadcast {
 public:
  /// \param but  a topic to skip
  TopicBroadcast(ros::NodeHandle& nh, const Simulation& simulation, const Frames& frames,
                 const std::string& but);

  /// Sends messages that are new since the last call; after a jump, all.
  void send(const Simulation& simulation, const ros::Time& stamp, bool jumped);

 private:
  struct Sent {
    std::size_t topic;
    std::unique_ptr<Outlet> outlet;
    double count = 0;  ///< count of the last message sent
  };
  std::vector<Sent> topics_;
};

}  // namespace quadcore::node
