#pragma once

#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"
#include "ros_types.hpp"

namespace quadcore::node {

/// Sends what plugins publish, each topic under its own name in the type of its kind.
class TopicBroadcast {
 public:
  /// \param frame_prefix  before tf's names of links
  /// \param but  a topic that somebody else sends
  TopicBroadcast(ros::NodeHandle& nh, const Simulation& simulation, const std::string& frame_prefix,
                 const std::string& but);

  /// Sends what is new since the last call; after a jump everything.
  void send(const Simulation& simulation, const ros::Time& stamp, bool jumped);

 private:
  struct Sent {
    std::size_t topic;
    std::unique_ptr<Outlet> outlet;
    double count = 0;  ///< of the message that was sent last
  };
  std::vector<Sent> topics_;
};

}  // namespace quadcore::node
