#pragma once

#include <ros/callback_queue_interface.h>

#include <cstdint>

namespace quadcore::node {

/// Runs each callback at once, in the thread of roscpp that has read the message. This saves the
/// hand-over to a thread of callbacks. The callbacks must not wait, because this thread reads and
/// sends all messages of the node.
class CallerQueue final : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
    callback->call();
  }
  void removeByID(std::uint64_t) override {}
};

}  // namespace quadcore::node
