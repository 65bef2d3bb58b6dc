#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "quadcore/simulation.hpp"
#include "ros_types.hpp"
#include "warning_limiter.hpp"

namespace quadcore::node {

/// Subscribes to topics for plugins, each under its own name in the type of its kind. Messages wait
/// in a separate queue until the flight takes them.
class TopicInlets {
 public:
  /// \param but  topics to skip
  /// \param lockstep  whether the flight waits for commands: then messages sent before a command
  /// arrive before its step
  TopicInlets(ros::NodeHandle nh, const Simulation& simulation, const std::vector<std::string>& but,
              bool lockstep);
  ~TopicInlets();
  TopicInlets(const TopicInlets&) = delete;
  TopicInlets& operator=(const TopicInlets&) = delete;

  /// Whether take() waits for roscpp to read its sockets: if a publisher is connected in lockstep.
  bool waits() const;
  /// Publishes received messages in the simulation; call before a step, in the flight's thread.
  void take(Simulation& simulation);

 private:
  void wait_for_sockets();

  ros::CallbackQueue queue_;
  std::vector<ros::Subscriber> subscribers_;
  Simulation* simulation_ = nullptr;  ///< during take()
  WarningLimiter limiter_;

  const bool lockstep_;
  std::mutex mutex_;
  std::condition_variable turned_;
  std::int64_t turns_ = 0;  ///< turns in which roscpp reads all sockets
  std::thread::id reader_;  ///< roscpp's thread that reads them
  boost::signals2::connection poll_;
};

}  // namespace quadcore::node
