#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace quadcore::node {

/// Recipients of the last message when a node subscribes.
enum class Resend {
  to_newcomer,  ///< only the new subscriber; it may get earlier messages after this one
  to_all        ///< all, in order, for messages that may be repeated, such as a clock
};

/// Publishes a latched topic. Unlike with roscpp's latch, the recipients of a resent message are
/// defined. Copies share the topic; an empty publisher has no topic.
template <class Message>
class LatchedPublisher {
 public:
  LatchedPublisher() = default;
  LatchedPublisher(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                   Resend again = Resend::to_newcomer)
      : kept_(std::make_shared<Kept>()) {
    const auto send_again =
        [again, weak = std::weak_ptr<Kept>(kept_)](const ros::SingleSubscriberPublisher& newcomer) {
          const std::shared_ptr<Kept> kept = weak.lock();
          if (!kept) return;
          const std::lock_guard<std::mutex> lock(kept->mutex);
          if (!kept->any) return;
          if (again == Resend::to_all) {
            kept->publisher.publish(kept->last);
          } else {
            newcomer.publish(kept->last);
          }
        };
    const std::lock_guard<std::mutex> lock(kept_->mutex);
    kept_->publisher = nh.advertise<Message>(topic, queue_size, send_again);
  }

  explicit operator bool() const { return kept_ != nullptr; }

  void publish(const Message& message) {
    const std::lock_guard<std::mutex> lock(kept_->mutex);
    kept_->last = message;
    kept_->any = true;
    kept_->publisher.publish(message);
  }

  /// Stores a message for new subscribers only.
  void keep(const Message& message) {
    const std::lock_guard<std::mutex> lock(kept_->mutex);
    kept_->last = message;
    kept_->any = true;
  }

  /// Sends the last message again to all.
  void repeat() {
    const std::lock_guard<std::mutex> lock(kept_->mutex);
    if (kept_->any) kept_->publisher.publish(kept_->last);
  }

  void shutdown() { kept_->publisher.shutdown(); }

 private:
  struct Kept {
    std::mutex mutex;
    bool any = false;
    Message last;
    ros::Publisher publisher;
  };

  std::shared_ptr<Kept> kept_;
};

}  // namespace quadcore::node
