#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"
#include "ros_types.hpp"
#include "sayer.hpp"

namespace quadcore::node {

/// Takes what others publish for plugins, each topic under its own name in the type of its kind.
/// Messages wait in a queue of their own until the flight takes them.
class TopicInlets {
 public:
  /// \param but  topics that somebody else takes
  /// \param lockstep  whether the flight waits for commands: then what was sent before a command
  ///                  is there before its step
  TopicInlets(ros::NodeHandle nh, const Simulation& simulation, const std::vector<std::string>& but,
              bool lockstep);
  ~TopicInlets();
  TopicInlets(const TopicInlets&) = delete;
  TopicInlets& operator=(const TopicInlets&) = delete;

  /// Publishes in the simulation what has come; to be called before a step, in its thread.
  void take(Simulation& simulation);

 private:
  void wait_for_sockets();

  ros::CallbackQueue queue_;
  std::vector<ros::Subscriber> subscribers_;
  Simulation* simulation_ = nullptr;  ///< while it takes
  Sayer sayer_;

  const bool lockstep_;
  std::mutex mutex_;
  std::condition_variable turned_;
  std::int64_t turns_ = 0;  ///< that roscpp has begun to look at all sockets
  boost::signals2::connection poll_;
};

}  // namespace quadcore::node
