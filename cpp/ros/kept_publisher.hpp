#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace quadcore::node {

/// Publishes a topic and keeps the last message for those who subscribe later. roscpp's own latch
/// sends that one beside what is being published, and may do so after a later message: a clock
/// would step back. This one may send a message twice, which only a clock bears. Copies share the
/// topic; an empty one has none.
template <class Message>
class KeptPublisher {
 public:
  KeptPublisher() = default;
  KeptPublisher(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size)
      : kept_(std::make_shared<Kept>()) {
    publisher_ = nh.advertise<Message>(topic, queue_size,
                                       [kept = kept_](const ros::SingleSubscriberPublisher& one) {
                                         const std::lock_guard<std::mutex> lock(kept->mutex);
                                         if (kept->any) one.publish(kept->last);
                                       });
  }

  explicit operator bool() const { return static_cast<bool>(publisher_); }

  void publish(const Message& message) {
    const std::lock_guard<std::mutex> lock(kept_->mutex);
    kept_->last = message;
    kept_->any = true;
    publisher_.publish(message);
  }

  /// Sends the last message again, to all.
  void repeat() {
    const std::lock_guard<std::mutex> lock(kept_->mutex);
    if (kept_->any) publisher_.publish(kept_->last);
  }

  void shutdown() { publisher_.shutdown(); }

 private:
  struct Kept {
    std::mutex mutex;
    bool any = false;
    Message last;
  };

  std::shared_ptr<Kept> kept_;
  ros::Publisher publisher_;
};

}  // namespace quadcore::node
