#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace quadcore::node {

/// Who is sent the last message when somebody subscribes.
enum class Again {
  to_newcomer,  ///< he alone, who may see earlier ones that are on their way to all after it
  to_all        ///< everybody, in order: what steps back for nobody and may come twice, as a clock
};

/// Publishes a topic and keeps the last message for those who subscribe later. Unlike roscpp's
/// latch it says who else gets that one. Copies share the topic; an empty one has none.
template <class Message>
class KeptPublisher {
 public:
  KeptPublisher() = default;
  KeptPublisher(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                Again again = Again::to_newcomer)
      : kept_(std::make_shared<Kept>()) {
    const auto send_again =
        [again, weak = std::weak_ptr<Kept>(kept_)](const ros::SingleSubscriberPublisher& newcomer) {
          const std::shared_ptr<Kept> kept = weak.lock();
          if (!kept) return;
          const std::lock_guard<std::mutex> lock(kept->mutex);
          if (!kept->any) return;
          if (again == Again::to_all) {
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

  /// Sends the last message again, to all.
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
