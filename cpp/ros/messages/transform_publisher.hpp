#pragma once

#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <memory>

namespace quadcore::node {

/// Publishes /tf, with the last message for each new subscriber. tf2 warns with TF_REPEATED_DATA of
/// a stamp that a frame has already had, so no subscriber gets a stamp twice. roscpp's latch cannot
/// ensure this: it sends the last message to a new subscriber even if that message is still in the
/// queue for all subscribers. An empty publisher has no topic.
class TransformPublisher {
 public:
  TransformPublisher() = default;
  explicit TransformPublisher(ros::NodeHandle& nh);

  explicit operator bool() const { return shared_ != nullptr; }

  /// Publishes transforms and sets their stamps to `time`. If the last message had this time, the
  /// stamp is 1 ns after the last one.
  void publish(tf2_msgs::TFMessage& transforms, const ros::Time& time);
  /// Whether a new subscriber may not have received the last message. If so, publish it again.
  bool has_unserved_subscriber() const;

 private:
  class Shared;

  std::shared_ptr<Shared> shared_;
};

}  // namespace quadcore::node
